#include "emulator/base/stopwatch.hpp"

#include <stdlib.h>

#include <catch2/catch.hpp>

using racebeam::Clocks;
using racebeam::Stopwatch;

namespace {

std::int64_t wall, processor;
const Clocks kClocks{[] { return wall; }, [] { return processor; }};

// An empty value removes the variable.
void set_variable(const char* name, const char* value) {
#if defined(_WIN32)
  ::_putenv_s(name, value);
#else
  *value == '\0' ? ::unsetenv(name) : ::setenv(name, value, 1);
#endif
}

std::int64_t measure(std::int64_t passed, std::int64_t used) {
  const Stopwatch watch(kClocks);
  wall += passed;
  processor += used;
  return watch.elapsed();
}

TEST_CASE("A stopwatch does not count the time in which other programs ran") {
  CHECK(measure(5000, 5000) == 5000);
  CHECK(measure(50'000'000, 5000) == 5000);
}

TEST_CASE("Where processor time is counted in ticks, a stopwatch counts wall time") {
  CHECK(measure(5000, 0) == 5000);
  CHECK(measure(5000, 10'000'000) == 5000);
}

TEST_CASE("The host's clocks count nanoseconds, and never go back") {
  const Clocks& host = racebeam::host_clocks();
  for (const auto clock : {host.wall, host.processor}) {
    const std::int64_t began = clock();
    std::int64_t before = began;
    while (before - began < 2'000'000) {
      const std::int64_t now = clock();
      REQUIRE(now >= before);
      before = now;
    }
  }
}

TEST_CASE("The environment decides whether policies measure") {
  const auto fixed = [](const char* value) {
    set_variable("RACEBEAM_POLICY", value);
    return racebeam::policies_are_fixed();
  };
  CHECK(fixed("fixed"));
  CHECK_FALSE(fixed("measured"));
  CHECK_THROWS_WITH(fixed("Fixed"), "RACEBEAM_POLICY is 'Fixed'; accepted: fixed and measured");
  set_variable("RACEBEAM_POLICY", "");
  CHECK_FALSE(racebeam::policies_are_fixed());
}

}  // namespace

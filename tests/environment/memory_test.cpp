// Saved states that are released leave no memory allocated.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

long resident_kilobytes() {
  std::ifstream statm("/proc/self/statm");
  long total = 0, resident = 0;
  statm >> total >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

TEST_CASE("A hundred thousand restores leave the process as large as it was") {
  Environment environment = test::steered();
  auto saved = environment.save(true);
  const auto bytes = to_bytes(*saved, environment);
  const auto restore = [&](int count) {
    for (int i = 0; i < count; ++i) {
      environment.restore(i % 100 == 0 ? *from_bytes(bytes, environment) : *saved);
      if (i % 10 == 0) environment.act(i / 10 % 18);
      if (i % 50 == 0) saved = environment.save(true);
    }
  };
  restore(2000);
  const long before = resident_kilobytes();
  REQUIRE(before > 0);
  restore(100000);
#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer keeps released memory
  CHECK(resident_kilobytes() - before < 1024);
#endif
}

}  // namespace
}  // namespace racebeam

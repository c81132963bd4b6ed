// Saved states that are released leave no memory allocated.
#include <catch2/catch.hpp>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "system/resources.hpp"
#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

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
  const std::uint64_t before = resident_memory();
  REQUIRE(before > 0);
  restore(100000);
#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer keeps released memory
  CHECK(resident_memory() < before + (1U << 20));
#endif
}

}  // namespace
}  // namespace racebeam

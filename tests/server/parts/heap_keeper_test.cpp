#include "server/operation/heap_keeper.hpp"

#include <catch2/catch.hpp>

using namespace racebeam;
using namespace std::chrono_literals;

TEST_CASE("Memory goes back to the system once many sessions have ended, and no session ends any more") {
  HeapKeeper keeper;
  auto now = HeapKeeper::Clock::now();
  const auto look = [&](std::int64_t sessions, std::chrono::milliseconds later) {
    keeper.update(sessions, now += later);
    return keeper.times();
  };
  CHECK(look(100, 250ms) == 0);
  CHECK(look(100, 2s) == 0);
  for (std::int64_t allocations = 99; allocations > 0; --allocations) CHECK(look(allocations, 250ms) == 0);
  CHECK(look(1, 500ms) == 0);
  CHECK(look(1, 1s) == 1);
  CHECK(look(1, 2s) == 1);
  CHECK(look(10, 2s) == 1);
  CHECK(look(1, 2s) == 1);  // so few leave little behind
  CHECK(look(1, 2s) == 1);
}

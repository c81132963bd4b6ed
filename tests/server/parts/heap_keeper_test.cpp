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

TEST_CASE("Memory of sixteen sessions goes back, a second after the last has ended") {
  for (const std::int64_t ended : {15, 16}) {
    HeapKeeper keeper;
    auto now = HeapKeeper::Clock::now();
    keeper.update(20, now);
    keeper.update(20 - ended, now += 5s);
    keeper.update(20 - ended, now += 1s - 1ns);
    CHECK(keeper.times() == 0);
    keeper.update(20 - ended, now += 1ns);
    CHECK(keeper.times() == (ended == 16 ? 1 : 0));
  }
}

TEST_CASE("Memory that went back does not go again before as many sessions have come and ended") {
  HeapKeeper keeper;
  auto now = HeapKeeper::Clock::now();
  for (const std::int64_t sessions : {30, 10, 10, 25, 10, 10}) keeper.update(sessions, now += 2s);
  CHECK(keeper.times() == 1);
  for (const std::int64_t sessions : {26, 10, 10}) keeper.update(sessions, now += 2s);
  CHECK(keeper.times() == 2);
}

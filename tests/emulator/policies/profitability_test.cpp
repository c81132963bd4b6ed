#include "emulator/policies/profitability.hpp"

#include <catch2/catch.hpp>

#include "emulator/policies/tuning.hpp"

using racebeam::Profitability;

namespace {

constexpr std::int32_t kEven = racebeam::tuning::kBreakEvenCycles;

int entered(Profitability& block, int times) {
  int count = 0;
  for (int i = 0; i < times; ++i) count += block.is_unprofitable() ? 0 : 1;
  return count;
}

TEST_CASE("A block that is left at once is interpreted, and tried one of 64 times") {
  Profitability block;
  int entries = 0;
  for (; !block.is_unprofitable(); ++entries) block.record(0);
  CHECK(entries == 4);
  CHECK(entered(block, 62) == 0);  // the last question of the loop is one of 63
  CHECK(entered(block, 1) == 1);
  CHECK(entered(block, 640) == 10);
}

TEST_CASE("The mean of a block's entries counts, in whatever order they come") {
  Profitability block;
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) block.record(kEven / 2);
    block.record(3 * kEven);
    REQUIRE_FALSE(block.is_unprofitable());
  }
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) block.record(kEven / 2);
    block.record(kEven);
  }
  CHECK(block.is_unprofitable());
}

TEST_CASE("A block whose entries become longer is profitable again, whatever came before") {
  Profitability block;
  for (int i = 0; i < 1000; ++i) block.record(0);
  CHECK(block.is_unprofitable());
  block.record(kEven + 1);
  CHECK(entered(block, 100) == 100);
}

}  // namespace

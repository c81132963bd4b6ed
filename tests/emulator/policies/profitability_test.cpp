#include "emulator/policies/profitability.hpp"

#include <catch2/catch.hpp>

#include "emulator/policies/tuning.hpp"

using racebeam::Profitability;

namespace {

constexpr std::int32_t kEven = racebeam::tuning::kBreakEvenCycles;

int entered(Profitability& machine, int searches) {
  int count = 0;
  for (int i = 0; i < searches; ++i) count += machine.is_unprofitable() ? 0 : 1;
  return count;
}

// How many entries of no cycle a machine makes before it interprets.
int entries_in_vain(Profitability& machine) {
  int entries = 0;
  for (; !machine.is_unprofitable(); ++entries) machine.record(0);
  return entries;
}

TEST_CASE("A machine whose entries are left at once interprets, and enters one of 64 times") {
  Profitability machine;
  CHECK(entries_in_vain(machine) == 4);
  CHECK(entered(machine, 62) == 0);  // the last question of the loop is one of 63
  CHECK(entered(machine, 1) == 1);
  CHECK(entered(machine, 640) == 10);
}

TEST_CASE("The mean of a machine's entries counts, in whatever order they come") {
  Profitability machine;
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) machine.record(kEven / 2);
    machine.record(3 * kEven);
    REQUIRE_FALSE(machine.is_unprofitable());
  }
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) machine.record(kEven / 2);
    machine.record(kEven);
  }
  CHECK(machine.is_unprofitable());
}

TEST_CASE("Entries that pay make up for short ones, but only for so many") {
  Profitability machine;
  machine.record(kEven + 320);
  CHECK(entries_in_vain(machine) == 4 + 10);
  machine = Profitability();
  for (int i = 0; i < 1000; ++i) machine.record(20'000);
  CHECK(entries_in_vain(machine) == 4 + 4096 / kEven);
}

TEST_CASE("A machine whose entries become longer enters again, whatever came before") {
  Profitability machine;
  for (int i = 0; i < 1000; ++i) machine.record(0);
  CHECK(machine.is_unprofitable());
  machine.record(kEven + 1);
  CHECK(entered(machine, 100) == 100);
}

}  // namespace

// What a machine counts for: its pictures, its records of lines and its stack, by what it has done.
#include "protocol/line/machine_memory.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "emulator/tia/line_cache/line_record.hpp"
#include "protocol/line/loaded_machine.hpp"

using namespace racebeam;

namespace {

constexpr std::size_t kHeight = 210, kPixels = kHeight * kScreenWidth;
constexpr std::size_t kPicture = kPixels + kHeight * sizeof(LineNumber);
constexpr std::size_t kRecords = kHeight * sizeof(LineRecord);

struct Machine {
  explicit Machine(Drawing drawing) { slot.set_drawing(drawing); }

  std::size_t held() const { return memory.held(slot); }
  std::size_t played() {
    slot.act({});
    return held();
  }
  std::size_t rested() {
    memory.release_caches(slot);
    return held();
  }

  Slot slot{{load_image("builtin:beamfall"), find_game("beamfall")}, slot_settings({})};
  MachineMemory memory{slot};
};

}  // namespace

TEST_CASE("A machine that has not played holds a spare picture and records of lines until it rests") {
  Machine machine(Drawing::kLast);
  const std::size_t fresh = machine.held();
  CHECK(fresh - machine.rested() == kPicture + kRecords);
  CHECK(machine.held() > 1024);  // the rest of the machine
}

TEST_CASE("A machine that plays holds two pictures, or one if its screens are not observed") {
  Machine seen(Drawing::kLast), both(Drawing::kLastTwo), unseen(Drawing::kNone);
  const std::size_t fresh = seen.held();
  CHECK(seen.played() == fresh + kPicture);
  CHECK(both.played() == fresh + kPicture);
  CHECK(unseen.played() == fresh);
  CHECK(seen.held() <= MachineMemory::kMax);
}

TEST_CASE("The records of lines are held from a frame until the next rest") {
  for (const Drawing drawing : {Drawing::kLast, Drawing::kNone}) {
    Machine machine(drawing);
    const std::size_t played = machine.played(), rested = machine.rested();
    CHECK(played - rested == kRecords);
    CHECK(machine.rested() == rested);
    CHECK(machine.played() == played);
  }
}

TEST_CASE("A stack counts with its screens, and with the picture that it takes in, of each channel") {
  for (const bool rgb : {false, true}) {
    Machine machine(Drawing::kLastTwo);
    const std::size_t without = machine.held(), channels = rgb ? 3 : 1;
    machine.slot.set_stack(StackSettings{.depth = 4, .width = 84, .height = 84, .rgb = rgb});
    const std::size_t screen = 84 * 84 * channels;
    CHECK(machine.slot.stack()->size() == 4 * screen);
    const std::size_t least = 4 * screen + channels * kPixels + kHeight * ScreenStack::kBytesOfRow;
    CHECK(machine.held() - without >= least);
    CHECK(machine.held() - without <= least + channels * screen);
    machine.slot.set_stack(std::nullopt);
    CHECK(machine.held() == without);
  }
}

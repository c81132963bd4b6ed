// What a machine counts for: its pictures, its records of lines, its stack and the RAM of its cartridge.
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

Cartridge beamfall(const std::string& scheme) {
  const auto image = load_image("builtin:beamfall");
  PlaySettings settings;
  settings.console.set("scheme", scheme);
  return {image, with_overrides(find_game("beamfall"), *image, settings.console)};
}

struct Machine {
  explicit Machine(Drawing drawing, const std::string& scheme = "4K")
      : slot(beamfall(scheme), slot_settings({})) {
    slot.set_drawing(drawing);
  }

  std::size_t held() const { return machine_memory(slot); }
  std::size_t played(int acts = 4) {
    for (int n = 0; n < acts; ++n) slot.act({});
    return held();
  }
  std::size_t rested() {
    slot.environment().release_caches();
    return held();
  }

  Slot slot;
};

}  // namespace

TEST_CASE("A machine that plays holds two pictures and records of lines, and gives the records back") {
  for (const Drawing drawing : {Drawing::kLast, Drawing::kLastTwo, Drawing::kEvery}) {
    Machine machine(drawing);
    const std::size_t played = machine.played(), rested = machine.rested();
    CHECK(played >= 2 * kPicture + kRecords);
    CHECK(played <= kMaxMachineMemory);
    CHECK(played - rested >= kRecords);
    CHECK(rested >= 2 * kPicture);
    CHECK(machine.rested() == rested);
    CHECK(machine.played() == played);
  }
}

TEST_CASE("A machine whose screens are not observed holds less, until one is looked at") {
  Machine seen(Drawing::kLast), unseen(Drawing::kNone);
  const std::size_t most = seen.played(), before = unseen.played();
  CHECK(before + kPicture <= most);
  CHECK(unseen.slot.environment().screen().size() == kPixels);
  CHECK(unseen.held() >= before + kPicture);
}

TEST_CASE("RAM on the cartridge counts, in a machine and in a state") {
  constexpr std::size_t kRam = 262144;
  Machine plain(Drawing::kLast), large(Drawing::kLast, "3EX");
  CHECK(plain.slot.environment().cartridge_ram_size() == 0);
  CHECK(large.slot.environment().cartridge_ram_size() == kRam);
  CHECK(large.held() >= kRam + 14 * 1024);
  CHECK(large.slot.save(false).footprint() == plain.slot.save(false).footprint() + kRam);
}

TEST_CASE("A stack counts with its screens, and with the picture that it takes in, of each channel") {
  for (const bool rgb : {false, true}) {
    Machine machine(Drawing::kLastTwo);
    machine.played();
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

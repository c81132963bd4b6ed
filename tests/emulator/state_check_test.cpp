// Values that no machine has are refused by name (docs/states.md). That accepted states do no harm is tested
// in tests/environment/saved/saved_state_fuzz_test.cpp.
#include "emulator/state_check.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <functional>
#include <limits>

#include "emulator/cartridge/harmony/cdf.hpp"
#include "emulator/cartridge/harmony/dpcplus.hpp"
#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/cartridge/mappers/savecircuit.hpp"
#include "emulator/console.hpp"
#include "emulator/state/power_on.hpp"
#include "emulator/tia/line/objects.hpp"
#include "system/invalid_input.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

constexpr std::int32_t kMaxLines = 3 * (kEndlessCycle / 228) + 228;

// A console that has run five frames.
class Machine {
 public:
  explicit Machine(const Image& image, std::string_view scheme = {})
      : console_(image.bytes, {.format = Format::kNtsc, .scheme = scheme}, power_on_) {
    for (int frame = 0; frame < 5; ++frame) console_.step();
  }

  // The refusal of its state, of which `spoil` has changed a field; empty: none.
  std::string refusal(const std::function<void(State&)>& spoil) const {
    State state = console_.state();
    spoil(state);
    try {
      console_.check(state, console_.cartridge_ram());
      return "";
    } catch (const InvalidInput& error) {
      return error.what();
    }
  }

 private:
  SystemGenerator power_on_{1};
  Console console_;
};

Machine random_machine(std::string_view scheme) { return Machine(*test::random_image(scheme, 1), scheme); }

struct Wrong {
  const char* sentence;
  std::function<void(State&)> spoil;
};

TEST_CASE("A state with a value that no machine has is refused by the field's name") {
  const Machine machine(*test::counter_image());
  REQUIRE(machine.refusal([](State&) {}).empty());
  const Wrong wrongs[] = {
      {"the cycle is -1", [](State& s) { s.cycle = -1; }},
      {"the cycle is 536870912", [](State& s) { s.cycle = kEndlessCycle; }},
      {"the number of draws", [](State& s) { s.drawn = (1U << 27) + 1; }},
      {"the processor's status", [](State& s) { s.cpu.P |= 0x10; }},
      {"the processor's status", [](State& s) { s.cpu.P |= 0x20; }},
      {"a spare byte of the processor", [](State& s) { s.cpu.spare[2] = 1; }},
      {"the timer's late flag", [](State& s) { s.riot.late = 2; }},
      {"CTRLPF is 8", [](State& s) { s.tia.ctrlpf = 0x08; }},
      {"CTRLPF is 64", [](State& s) { s.tia.ctrlpf = 0x40; }},
      {"CTRLPF is 128", [](State& s) { s.tia.ctrlpf = 0x80; }},
      {"the playfield's reflection", [](State& s) { s.tia.reflect = 2; }},
      {"a player's REFP", [](State& s) { s.tia.player[0].refp = 2; }},
      {"a player's VDELP", [](State& s) { s.tia.player[1].vdel = 2; }},
      {"a player's skip flag", [](State& s) { s.tia.player[0].skip = 2; }},
      {"a player's NUSIZ is 64", [](State& s) { s.tia.player[1].nusiz = 0x40; }},
      {"a player's NUSIZ is 128", [](State& s) { s.tia.player[1].nusiz = 0x80; }},
      {"a missile's ENAM", [](State& s) { s.tia.missile[1].enabled = 2; }},
      {"a missile's RESMP", [](State& s) { s.tia.missile[0].locked = 2; }},
      {"a missile's motion is 16", [](State& s) { s.tia.missile[1].motion = 16; }},
      {"the ball's ENABL", [](State& s) { s.tia.ball.enabled = 2; }},
      {"the ball's old ENABL", [](State& s) { s.tia.ball.old_enabled = 2; }},
      {"the ball's VDELBL", [](State& s) { s.tia.ball.vdel = 2; }},
      {"the ball's motion is 16", [](State& s) { s.tia.ball.motion = 16; }},
      {"the blank flag", [](State& s) { s.tia.vblank = 2; }},
      {"the comb flag", [](State& s) { s.tia.comb_armed = 2; }},
      {"the Cosmic Ark flag", [](State& s) { s.tia.cosmic = 2; }},
      {"a spare byte of the TIA", [](State& s) { s.tia.spare[3] = 1; }},
      {"a spare byte of the picture", [](State& s) { s.tia.spare_bytes[1] = 1; }},
      {"the frame's origin is -228", [](State& s) { s.tia.origin = -228; }},
      {"the frame's origin modulo 3 is -1", [](State& s) { s.tia.origin = -1; }},
      {"the clocks left on the line is -1", [](State& s) { s.tia.left = -1; }},
      {"the number of lines", [](State& s) { s.frame.lines = kMaxLines + 1; }},
      {"the flag of a paddle's capacitor", [](State& s) { s.frame.dumping = 2; }},
      {"the flag of an open frame", [](State& s) { s.frame.open = 2; }},
      {"the paddles' buttons is 16", [](State& s) { s.inputs.paddle_fire = 16; }},
      {"the processor's jam flag is 2; it must be from 0 to 1", [](State& s) { s.cpu.jammed = 2; }},
      {"the timer's shift is 40; it must be 0, 3, 6 or 10", [](State& s) { s.riot.shift = 40; }},
      {"a player's position is 160", [](State& s) { s.tia.player[1].position = 160; }},
      {"a player's motion is 16", [](State& s) { s.tia.player[0].motion = 16; }},
      {"a player's NUSIZ", [](State& s) { s.tia.player[0].nusiz = 8; }},
      {"a missile's position is 255", [](State& s) { s.tia.missile[0].position = 255; }},
      {"the ball's position is 200", [](State& s) { s.tia.ball.position = 200; }},
      {"the set of enabled objects", [](State& s) { s.tia.enabled ^= 1; }},
      {"the Cosmic Ark count", [](State& s) { s.tia.cosmic_count = 4; }},
      {"the Cosmic Ark shape", [](State& s) { s.tia.cosmic_shape = static_cast<CosmicShape>(3); }},
      {"the frame's origin is 3", [](State& s) { s.tia.origin = 3; }},
      {"the clocks left on the line is 229", [](State& s) { s.tia.left = 229; }},
      {"the beam's clock", [](State& s) { s.tia.cursor = 1 << 30; }},
      {"the next pixel", [](State& s) { s.tia.pixel += 160; }},
      {"the collisions", [](State& s) { s.tia.collisions |= 1U << 12; }},
      {"the number of lines", [](State& s) { s.frame.lines = -1; }},
      {"the flag of a greyed frame", [](State& s) { s.frame.greyed = 1, s.frame.open = 0; }},
      {"a cartridge of scheme 4K has no such banks", [](State& s) { s.cartridge.bank[3] = 1; }},
      {"a paddle's resistance is -1", [](State& s) { s.inputs.paddle[2] = -1; }},
      {"a joystick is 128", [](State& s) { s.inputs.joystick[1] = 128; }},
  };
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.sentence);
    CHECK_THAT(machine.refusal(wrong.spoil), Catch::Contains(wrong.sentence));
  }
}

TEST_CASE("A state is accepted with each value at its limit") {
  const Machine machine(*test::counter_image());
  const auto highest = [](State& state) {
    state.cycle = kEndlessCycle - 1;
    state.drawn = 1U << 27;
    state.cpu.P = 0xCF;
    state.cpu.jammed = state.riot.late = 1;
    state.tia.ctrlpf = 0x37;
    state.tia.reflect = state.tia.vblank = state.tia.comb_armed = state.tia.cosmic = 1;
    state.tia.player.fill({255, 255, 1, 1, 0x37, 159, 15, 1});
    state.tia.missile.fill({1, 1, 159, 15});
    state.tia.ball = {1, 1, 1, 159, 15};
    state.tia.cosmic_count = 3;
    state.tia.cosmic_shape = CosmicShape::kHidden;
    state.tia.enabled = enabled_objects(state.tia);
    state.tia.collisions = 0xEFFF;
    state.frame.lines = kMaxLines;
    state.frame.dumping = state.frame.open = state.frame.greyed = 1;
    state.inputs.paddle.fill(std::numeric_limits<std::int32_t>::max());
    state.inputs.joystick.fill(127);
    state.inputs.paddle_fire = 15;
  };
  CHECK(machine.refusal(highest).empty());
  for (const std::uint8_t shift : std::to_array<std::uint8_t>({0, 3, 6, 10}))
    CHECK(machine.refusal([shift](State& state) { state.riot.shift = shift; }).empty());
}

// Where the beam is: docs/spec/tia.md, 2. A picture begins 34 lines after the frame's origin, or at clock 0.
TEST_CASE("The beam's clock, the clocks left on its line and the next pixel must agree") {
  const Machine machine(*test::counter_image());
  const auto refusal = [&](int origin, int cursor, int left, int pixel) {
    return machine.refusal([=](State& state) {
      state.tia.origin = origin, state.tia.cursor = cursor, state.tia.left = left, state.tia.pixel = pixel;
    });
  };
  for (const int origin : {0, -3, -225}) {
    const int start = origin + 34 * 228, end = start + 210 * 228;
    INFO(origin);
    CHECK(refusal(origin, start, 228, 0).empty());
    CHECK(refusal(origin, start + 68, 160, 0).empty());
    CHECK(refusal(origin, start + 69, 159, 1).empty());
    CHECK(refusal(origin, start + 228, 0, 160).empty());
    CHECK(refusal(origin, start + 228, 228, 160).empty());
    CHECK(refusal(origin, end, 0, 210 * 160).empty());
    CHECK(refusal(origin, end, 228, 210 * 160).empty());
    CHECK(refusal(origin, 0, 228, 0).empty() == (origin == 0));
    CHECK(refusal(origin, 228 + 69, 159, 161).empty() == (origin == 0));
    CHECK_THAT(refusal(origin, start + 68, 160, 1), Catch::Contains("the next pixel is 1;"));
    CHECK_THAT(refusal(origin, start + 69, 159, 0), Catch::Contains("the next pixel is 0;"));
    CHECK_THAT(refusal(origin, start + 69, 160, 1), Catch::Contains("the next pixel"));
    CHECK_THAT(refusal(origin, start + 228, 228, 0), Catch::Contains("the next pixel"));
    CHECK_THAT(refusal(origin, start - 228, 228, -160), Catch::Contains("the next pixel"));
    CHECK_THAT(refusal(origin, -1, 228, 0), Catch::Contains("the beam's clock is -1"));
    CHECK_THAT(refusal(origin, end + 1, 227, 210 * 160), Catch::Contains("the beam's clock"));
  }
}

// The largest valid value of a byte of CartridgeState::bank; 0 for those that are not listed.
struct Most {
  const char* scheme;
  std::size_t index;
  std::uint8_t most;
};

constexpr std::uint8_t kAny = 255;
const std::vector<Most> kMax = {
    {"F8", 0, 1},      {"F8 swapped", 0, 1}, {"F8SC", 0, 1},    {"F6", 0, 3},       {"F6SC", 0, 3},
    {"F4", 0, 7},      {"F4SC", 0, 7},       {"FASC", 0, 2},    {"E0", 0, 7},       {"E0", 1, 7},
    {"E0", 2, 7},      {"E0", 3, 7},         {"E7", 0, 7},      {"E7", 1, 3},       {"DPC", 0, 1},
    {"3F", 0, 3},      {"3E", 0, 7},         {"3E", 1, 31},     {"3E", 2, 1},       {"UA", 0, 1},
    {"AR", 0, kAny},   {"AR", 1, kAny},      {"AR", 2, 1},      {"MB", 0, 15},      {"3EX", 0, 7},
    {"3EX", 1, kAny},  {"3EX", 2, 1},        {"JANE", 0, 3},    {"UA clone", 0, 1}, {"UASW", 0, 1},
    {"0FA0", 0, 1},    {"0840", 0, 1},       {"03E0", 0, 7},    {"03E0", 1, 7},     {"03E0", 2, 7},
    {"03E0", 3, 7},    {"3E+", 0, 0xBF},     {"3E+", 1, 0xBF},  {"3E+", 2, 0xBF},   {"3E+", 3, 0xBF},
    {"FA2", 0, 6},     {"FC", 0, 7},         {"FC", 1, 7},      {"SB", 0, 31},      {"EF", 0, 15},
    {"EFSC", 0, 15},   {"DF", 0, 31},        {"DFSC", 0, 31},   {"BF", 0, 63},      {"BFSC", 0, 63},
    {"MC", 0, kAny},   {"MC", 1, kAny},      {"MC", 2, kAny},   {"MC", 3, kAny},    {"MC", 4, 1},
    {"DPC+", 0, 5},    {"DPC+", 1, 1},       {"DPC+", 2, 1},    {"CDFJ", 0, 6},     {"CDFJ", 1, 1},
    {"CDFJ", 2, 1},    {"CDFJ+", 0, 6},      {"CDFJ+", 1, 1},   {"CDFJ+", 2, 1},    {"X07", 0, 15},
    {"WD", 0, 7},      {"WD", 1, 7},         {"WD", 2, 3},      {"MDM", 0, 7},      {"MDM", 1, 1},
    {"4A50", 0, 0x4F}, {"4A50", 1, 0x4F},    {"4A50", 2, kAny}, {"4A50", 3, 1},     {"CDF0", 0, 6},
    {"CDF0", 1, 1},    {"CDF0", 2, 1},       {"CDF", 0, 6},     {"CDF", 1, 1},      {"CDF", 2, 1},
    {"WF8", 0, 1},     {"WDSW", 0, 7},       {"WDSW", 1, 7},    {"WDSW", 2, 3},     {"EFF", 0, 15}};

std::uint8_t most_of(std::string_view scheme, std::size_t index) {
  for (const Most& one : kMax)
    if (one.scheme == scheme && one.index == index) return one.most;
  return 0;
}

TEST_CASE("A state with a bank that the cartridge has not is refused, in every scheme") {
  for (const std::string_view scheme : test::random_schemes()) {
    const Machine machine = random_machine(scheme);
    REQUIRE(machine.refusal([](State&) {}).empty());
    for (std::size_t index = 0; index < 8; ++index) {
      INFO(scheme << ", bank " << index);
      const std::uint8_t most = most_of(scheme, index);
      const auto with_bank = [&](int bank) {
        return machine.refusal(
            [&](State& state) { state.cartridge.bank[index] = static_cast<std::uint8_t>(bank); });
      };
      CHECK(with_bank(most).empty());
      if (most == kAny) continue;
      CHECK_THAT(with_bank(most + 1), Catch::Contains("has no such banks"));
      CHECK_THAT(with_bank(255), Catch::Contains("has no such banks"));
    }
  }
}

TEST_CASE("E0's last window shows the last slice in every state") {
  const Machine machine = random_machine("E0");
  CHECK_THAT(machine.refusal([](State& state) { state.cartridge.bank[3] = 6; }),
             Catch::Contains("has no such banks"));
}

TEST_CASE("Bytes behind a cartridge's RAM must be zero") {
  for (const std::string_view scheme : {"F8", "F8SC", "E7", "DPC", "DPC+", "AR"}) {
    INFO(scheme);
    const Machine machine = random_machine(scheme);
    CHECK_THAT(machine.refusal([](State& state) { state.cartridge.ram[255] = 1; }),
               Catch::Contains("a byte behind the cartridge's RAM"));
  }
}

// A refusal after `spoil` has changed the chip.
template <class Chip>
std::string refusal_of_chip(const Machine& machine, const std::function<void(Chip&)>& spoil) {
  return machine.refusal([&](State& state) {
    Chip chip;
    std::memcpy(&chip, state.cartridge.ram.data(), sizeof chip);
    spoil(chip);
    std::memcpy(state.cartridge.ram.data(), &chip, sizeof chip);
  });
}

TEST_CASE("Registers that DPC's chip can't have are refused") {
  const Machine machine = random_machine("DPC");
  const auto with_chip = [&](const std::function<void(dpc::Chip&)>& spoil) {
    return refusal_of_chip(machine, spoil);
  };
  const auto highest = [](dpc::Chip& chip) { chip.fetcher[7].counter = 2047, chip.fetcher[7].music = 1; };
  CHECK(with_chip(highest).empty());
  const std::function<void(dpc::Chip&)> spoilt[] = {
      [](dpc::Chip& chip) { chip.fetcher[3].counter = 2048; },
      [](dpc::Chip& chip) { chip.fetcher[0].flag = 1; },
      [](dpc::Chip& chip) { chip.fetcher[4].music = 1; },
      [](dpc::Chip& chip) { chip.fetcher[5].music = 2; },
      [](dpc::Chip& chip) { chip.fraction = 1; },
      [](dpc::Chip& chip) { chip.fraction = std::numeric_limits<double>::quiet_NaN(); },
      [](dpc::Chip& chip) { chip.spare[6] = 1; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(with_chip(spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Registers that DPC+'s chip can't have are refused") {
  using dpcplus::Chip;
  const Machine machine = random_machine("DPC+");
  const auto highest = [](Chip& chip) {
    chip.fetcher.fill({4095, 255, 255});
    chip.fractional.fill({4095, 255, 255});
    chip.clock.voice.fill({0xFFFFFFFF, 0xFFFFFFFF});
    chip.waveform.fill(127);
    chip.random = 0xFFFFFFFF;
    chip.clock.instructions = harmony::kMaxInstructions;
    chip.clock.into_sample = harmony::kSampleParts - 1;
    chip.parameters = 8;
    chip.follower = {0x1FFF, 2, 0xFF};
    chip.stopped = 1;
  };
  CHECK(refusal_of_chip<Chip>(machine, highest).empty());
  const std::function<void(Chip&)> spoilt[] = {
      [](Chip& chip) { chip.fetcher[3].pointer = 4096; },
      [](Chip& chip) { chip.fractional[7].pointer = 4096; },
      [](Chip& chip) { chip.waveform[2] = 128; },
      [](Chip& chip) { chip.clock.instructions = harmony::kMaxInstructions + 1; },
      [](Chip& chip) { chip.clock.into_sample = harmony::kSampleParts; },
      [](Chip& chip) { chip.parameters = 9; },
      [](Chip& chip) { chip.follower.next = 0x2000; },
      [](Chip& chip) { chip.follower.missing = 3; },
      [](Chip& chip) { chip.stopped = 2; },
      [](Chip& chip) { chip.spare[2] = 1; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(refusal_of_chip(machine, spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Lines and bits that EFF's EEPROM can't have are refused") {
  using savecircuit::Eeprom;
  const Machine machine = random_machine("EFF");
  CHECK(refusal_of_chip<Eeprom>(machine, [](Eeprom& eeprom) {
          eeprom = {2047, savecircuit::kReads, 9, 255, 1, 1, 1};
        }).empty());
  const std::function<void(Eeprom&)> spoilt[] = {
      [](Eeprom& eeprom) { eeprom.pointer = 2048; }, [](Eeprom& eeprom) { eeprom.phase = 5; },
      [](Eeprom& eeprom) { eeprom.bits = 10; },      [](Eeprom& eeprom) { eeprom.clock = 2; },
      [](Eeprom& eeprom) { eeprom.data = 2; },       [](Eeprom& eeprom) { eeprom.pulls = 2; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(refusal_of_chip(machine, spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Registers that CDFJ's chip can't have are refused") {
  using cdf::Chip;
  const Machine machine = random_machine("CDFJ");
  const auto highest = [](Chip& chip) {
    chip.clock.voice.fill({0xFFFFFFFF, 0xFFFFFFFF});
    chip.clock.instructions = harmony::kMaxInstructions;
    chip.clock.into_sample = harmony::kSampleParts - 1;
    chip.follower = {0x1FFF, 2, 0xFF};
    chip.wave.fill(31);
    chip.plays_waves = 1, chip.jump = 0x22, chip.stopped = 1, chip.loads = 3, chip.first_stream = 220;
  };
  CHECK(refusal_of_chip<Chip>(machine, highest).empty());
  const std::function<void(Chip&)> spoilt[] = {
      [](Chip& chip) { chip.clock.instructions = harmony::kMaxInstructions + 1; },
      [](Chip& chip) { chip.clock.into_sample = harmony::kSampleParts; },
      [](Chip& chip) { chip.follower.next = 0x2000; },
      [](Chip& chip) { chip.follower.missing = 3; },
      [](Chip& chip) { chip.wave[0] = 19; },
      [](Chip& chip) { chip.wave[2] = 32; },
      [](Chip& chip) { chip.plays_waves = 2; },
      [](Chip& chip) { chip.jump = 0x20; },
      [](Chip& chip) { chip.jump = 0x23; },
      [](Chip& chip) { chip.stopped = 2; },
      [](Chip& chip) { chip.loads = 4; },
      [](Chip& chip) { chip.first_stream = 221; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(refusal_of_chip(machine, spoil), Catch::Contains("has no such banks or registers"));
}

}  // namespace
}  // namespace racebeam

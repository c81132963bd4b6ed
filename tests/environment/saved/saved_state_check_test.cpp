// Errors in a state are named. That accepted states do no harm is tested in saved_state_fuzz_test.cpp.
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <functional>
#include <limits>

#include "emulator/cartridge/mappers/cdf.hpp"
#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/cartridge/mappers/dpcplus.hpp"
#include "emulator/cartridge/mappers/savecircuit.hpp"
#include "emulator/tia/line/objects.hpp"
#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

using Values = Environment::Saved::Values;

constexpr std::int32_t kMostLines = 3 * (kEndlessCycle / 228) + 228;

struct Wrong {
  const char* sentence;
  std::function<void(Values&)> spoil;
};

// `spoil` changes one field of a valid state; the checksum of the bytes is right.
std::string refusal(Environment& environment, const std::function<void(Values&)>& spoil) {
  Environment::Saved saved = *environment.save(true);
  spoil(saved.values);
  try {
    from_bytes(to_bytes(saved, environment), environment);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST_CASE("A state with a value that no machine has is refused by the field's name") {
  Environment environment = test::steered();
  for (int i = 0; i < 5; ++i) environment.act(i);
  REQUIRE(refusal(environment, [](Values&) {}).empty());
  const Wrong wrongs[] = {
      {"the cycle is -1", [](Values& v) { v.machine.cycle = -1; }},
      {"the cycle is 536870912", [](Values& v) { v.machine.cycle = kEndlessCycle; }},
      {"the number of draws", [](Values& v) { v.machine.drawn = (1U << 27) + 1; }},
      {"the processor's status", [](Values& v) { v.machine.cpu.P |= 0x10; }},
      {"the processor's status", [](Values& v) { v.machine.cpu.P |= 0x20; }},
      {"a spare byte of the processor", [](Values& v) { v.machine.cpu.spare[2] = 1; }},
      {"the timer's late flag", [](Values& v) { v.machine.riot.late = 2; }},
      {"CTRLPF is 8", [](Values& v) { v.machine.tia.ctrlpf = 0x08; }},
      {"CTRLPF is 64", [](Values& v) { v.machine.tia.ctrlpf = 0x40; }},
      {"CTRLPF is 128", [](Values& v) { v.machine.tia.ctrlpf = 0x80; }},
      {"the playfield's reflection", [](Values& v) { v.machine.tia.reflect = 2; }},
      {"a player's REFP", [](Values& v) { v.machine.tia.player[0].refp = 2; }},
      {"a player's VDELP", [](Values& v) { v.machine.tia.player[1].vdel = 2; }},
      {"a player's skip flag", [](Values& v) { v.machine.tia.player[0].skip = 2; }},
      {"a player's NUSIZ is 64", [](Values& v) { v.machine.tia.player[1].nusiz = 0x40; }},
      {"a player's NUSIZ is 128", [](Values& v) { v.machine.tia.player[1].nusiz = 0x80; }},
      {"a missile's ENAM", [](Values& v) { v.machine.tia.missile[1].enabled = 2; }},
      {"a missile's RESMP", [](Values& v) { v.machine.tia.missile[0].locked = 2; }},
      {"a missile's motion is 16", [](Values& v) { v.machine.tia.missile[1].motion = 16; }},
      {"the ball's ENABL", [](Values& v) { v.machine.tia.ball.enabled = 2; }},
      {"the ball's old ENABL", [](Values& v) { v.machine.tia.ball.old_enabled = 2; }},
      {"the ball's VDELBL", [](Values& v) { v.machine.tia.ball.vdel = 2; }},
      {"the ball's motion is 16", [](Values& v) { v.machine.tia.ball.motion = 16; }},
      {"the blank flag", [](Values& v) { v.machine.tia.vblank = 2; }},
      {"the comb flag", [](Values& v) { v.machine.tia.comb_armed = 2; }},
      {"the Cosmic Ark flag", [](Values& v) { v.machine.tia.cosmic = 2; }},
      {"a spare byte of the TIA", [](Values& v) { v.machine.tia.spare[3] = 1; }},
      {"a spare byte of the picture", [](Values& v) { v.machine.tia.spare_bytes[1] = 1; }},
      {"the frame's origin is -228", [](Values& v) { v.machine.tia.origin = -228; }},
      {"the frame's origin modulo 3 is -1", [](Values& v) { v.machine.tia.origin = -1; }},
      {"the clocks left on the line is -1", [](Values& v) { v.machine.tia.left = -1; }},
      {"the number of lines", [](Values& v) { v.machine.frame.lines = kMostLines + 1; }},
      {"the flag of a paddle's capacitor", [](Values& v) { v.machine.frame.dumping = 2; }},
      {"the flag of an open frame", [](Values& v) { v.machine.frame.open = 2; }},
      {"the paddles' buttons is 16", [](Values& v) { v.machine.inputs.paddle_fire = 16; }},
      {"the frame number of the episode", [](Values& v) { v.play.episode_frames = 1U << 31; }},
      {"strength", [](Values& v) { v.play.held.b.strength = std::numeric_limits<float>::infinity(); }},
      {"the processor's jam flag is 2; it must be from 0 to 1", [](Values& v) { v.machine.cpu.jammed = 2; }},
      {"the timer's shift is 40; it must be 0, 3, 6 or 10", [](Values& v) { v.machine.riot.shift = 40; }},
      {"a player's position is 160", [](Values& v) { v.machine.tia.player[1].position = 160; }},
      {"a player's motion is 16", [](Values& v) { v.machine.tia.player[0].motion = 16; }},
      {"a player's NUSIZ", [](Values& v) { v.machine.tia.player[0].nusiz = 8; }},
      {"a missile's position is 255", [](Values& v) { v.machine.tia.missile[0].position = 255; }},
      {"the ball's position is 200", [](Values& v) { v.machine.tia.ball.position = 200; }},
      {"the set of enabled objects", [](Values& v) { v.machine.tia.enabled ^= 1; }},
      {"the Cosmic Ark count", [](Values& v) { v.machine.tia.cosmic_count = 4; }},
      {"the Cosmic Ark shape", [](Values& v) { v.machine.tia.cosmic_shape = static_cast<CosmicShape>(3); }},
      {"the frame's origin is 3", [](Values& v) { v.machine.tia.origin = 3; }},
      {"the clocks left on the line is 229", [](Values& v) { v.machine.tia.left = 229; }},
      {"the beam's clock", [](Values& v) { v.machine.tia.cursor = 1 << 30; }},
      {"the next pixel", [](Values& v) { v.machine.tia.pixel += 160; }},
      {"the collisions", [](Values& v) { v.machine.tia.collisions |= 1U << 12; }},
      {"the number of lines", [](Values& v) { v.machine.frame.lines = -1; }},
      {"the flag of a greyed frame", [](Values& v) { v.machine.frame.greyed = 1, v.machine.frame.open = 0; }},
      {"a cartridge of scheme 4K has no such banks", [](Values& v) { v.machine.cartridge.bank[3] = 1; }},
      {"a paddle's resistance is -1", [](Values& v) { v.machine.inputs.paddle[2] = -1; }},
      {"a joystick is 128", [](Values& v) { v.machine.inputs.joystick[1] = 128; }},
      {"strength", [](Values& v) { v.play.held.a.strength = std::numeric_limits<float>::quiet_NaN(); }},
      {"a turned paddle", [](Values& v) { v.play.paddles[0] = -5; }},
      {"the frame number is 4294967295", [](Values& v) { v.play.frames = 0xFFFFFFFF; }},
      {"the mode is 2; it must be one of 0, 1, 3", [](Values& v) { v.play.mode = 2; }},
      {"the difficulty is 9; it must be one of", [](Values& v) { v.play.switches.difficulty = 9; }},
      {"the switches that actions have moved is 8; it must be from 0 to 7",
       [](Values& v) { v.play.switches.moved = 8; }},
      {"the flag of outdated RAM", [](Values& v) { v.play.ram_is_stale = 2; }},
      {"a variable that the rule does not have", [](Values& v) { v.rule.values.back() = 1; }},
      {"the divider of a sound channel is 32", [](Values& v) { v.sound.channel[1].divider = 32; }},
  };
  for (const Wrong& wrong : wrongs) {
    INFO(wrong.sentence);
    CHECK_THAT(refusal(environment, wrong.spoil), Catch::Contains(wrong.sentence));
  }
}

TEST_CASE("A state is accepted with each value at its limit") {
  Environment environment = test::steered();
  for (int i = 0; i < 5; ++i) environment.act(i);
  const auto highest = [](Values& values) {
    State& machine = values.machine;
    machine.cycle = kEndlessCycle - 1;
    machine.drawn = 1U << 27;
    machine.cpu.P = 0xCF;
    machine.cpu.jammed = machine.riot.late = 1;
    machine.tia.ctrlpf = 0x37;
    machine.tia.reflect = machine.tia.vblank = machine.tia.comb_armed = machine.tia.cosmic = 1;
    machine.tia.player.fill({255, 255, 1, 1, 0x37, 159, 15, 1});
    machine.tia.missile.fill({1, 1, 159, 15});
    machine.tia.ball = {1, 1, 1, 159, 15};
    machine.tia.cosmic_count = 3;
    machine.tia.cosmic_shape = CosmicShape::kHidden;
    machine.tia.enabled = enabled_objects(machine.tia);
    machine.tia.collisions = 0xEFFF;
    machine.frame.lines = kMostLines;
    machine.frame.dumping = machine.frame.open = machine.frame.greyed = 1;
    machine.inputs.paddle.fill(std::numeric_limits<std::int32_t>::max());
    machine.inputs.joystick.fill(127);
    machine.inputs.paddle_fire = 15;
    values.play.paddles.fill(std::numeric_limits<std::int32_t>::max());
    values.play.frames = values.play.episode_frames = 0x7FFFFFFF;
    values.play.mode = 3;
    values.play.switches = {3, 7};
    values.play.ram_is_stale = 1;
    for (auto& channel : values.sound.channel) channel.divider = 31;
  };
  CHECK(refusal(environment, highest).empty());
  for (const std::uint8_t shift : std::to_array<std::uint8_t>({0, 3, 6, 10}))
    CHECK(refusal(environment, [shift](Values& v) { v.machine.riot.shift = shift; }).empty());
}

// The largest valid value of a byte of CartridgeState::bank; 0 for those that are not listed.
struct Most {
  const char* scheme;
  std::size_t index;
  std::uint8_t most;
};

constexpr std::uint8_t kAny = 255;
const std::vector<Most> kMost = {
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
  for (const Most& one : kMost)
    if (one.scheme == scheme && one.index == index) return one.most;
  return 0;
}

Environment random_machine(std::string_view scheme) {
  return {test::random_image(scheme, 1), test::random_game(scheme), test::plain()};
}

TEST_CASE("A state with a bank that the cartridge has not is refused, in every scheme") {
  for (const std::string_view scheme : test::random_schemes()) {
    Environment environment = random_machine(scheme);
    REQUIRE(refusal(environment, [](Values&) {}).empty());
    for (std::size_t index = 0; index < 8; ++index) {
      INFO(scheme << ", bank " << index);
      const std::uint8_t most = most_of(scheme, index);
      const auto with_bank = [&](int bank) {
        return refusal(environment, [&](Values& values) {
          values.machine.cartridge.bank[index] = static_cast<std::uint8_t>(bank);
        });
      };
      CHECK(with_bank(most).empty());
      if (most == kAny) continue;
      CHECK_THAT(with_bank(most + 1), Catch::Contains("has no such banks"));
      CHECK_THAT(with_bank(255), Catch::Contains("has no such banks"));
    }
  }
}

TEST_CASE("E0's last window shows the last slice in every state") {
  Environment environment = random_machine("E0");
  CHECK_THAT(refusal(environment, [](Values& values) { values.machine.cartridge.bank[3] = 6; }),
             Catch::Contains("has no such banks"));
}

TEST_CASE("Bytes behind a cartridge's RAM must be zero") {
  for (const std::string_view scheme : {"F8", "F8SC", "E7", "DPC", "DPC+", "AR"}) {
    INFO(scheme);
    Environment environment = random_machine(scheme);
    CHECK_THAT(refusal(environment, [](Values& values) { values.machine.cartridge.ram[255] = 1; }),
               Catch::Contains("a byte behind the cartridge's RAM"));
  }
}

// A refusal after `spoil` has changed the chip.
template <class Chip>
std::string refusal_of_chip(Environment& environment, const std::function<void(Chip&)>& spoil) {
  return refusal(environment, [&](Values& values) {
    Chip chip;
    std::memcpy(&chip, values.machine.cartridge.ram.data(), sizeof chip);
    spoil(chip);
    std::memcpy(values.machine.cartridge.ram.data(), &chip, sizeof chip);
  });
}

TEST_CASE("Registers that DPC's chip can't have are refused") {
  Environment environment = random_machine("DPC");
  const auto with_chip = [&](const std::function<void(dpc::Chip&)>& spoil) {
    return refusal_of_chip(environment, spoil);
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
  Environment environment = random_machine("DPC+");
  const auto highest = [](Chip& chip) {
    chip.fetcher.fill({4095, 255, 255});
    chip.fractional.fill({4095, 255, 255});
    chip.clock.voice.fill({0xFFFFFFFF, 0xFFFFFFFF});
    chip.waveform.fill(127);
    chip.random = 0xFFFFFFFF;
    chip.clock.instructions = harmony::kMostInstructions;
    chip.clock.into_sample = harmony::kSampleParts - 1;
    chip.parameters = 8;
    chip.follower = {0x1FFF, 2, 0xFF};
    chip.stopped = 1;
  };
  CHECK(refusal_of_chip<Chip>(environment, highest).empty());
  const std::function<void(Chip&)> spoilt[] = {
      [](Chip& chip) { chip.fetcher[3].pointer = 4096; },
      [](Chip& chip) { chip.fractional[7].pointer = 4096; },
      [](Chip& chip) { chip.waveform[2] = 128; },
      [](Chip& chip) { chip.clock.instructions = harmony::kMostInstructions + 1; },
      [](Chip& chip) { chip.clock.into_sample = harmony::kSampleParts; },
      [](Chip& chip) { chip.parameters = 9; },
      [](Chip& chip) { chip.follower.next = 0x2000; },
      [](Chip& chip) { chip.follower.missing = 3; },
      [](Chip& chip) { chip.stopped = 2; },
      [](Chip& chip) { chip.spare[2] = 1; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(refusal_of_chip(environment, spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Lines and bits that EFF's EEPROM can't have are refused") {
  using savecircuit::Eeprom;
  Environment environment = random_machine("EFF");
  CHECK(refusal_of_chip<Eeprom>(environment, [](Eeprom& eeprom) {
          eeprom = {2047, savecircuit::kReads, 9, 255, 1, 1, 1};
        }).empty());
  const std::function<void(Eeprom&)> spoilt[] = {
      [](Eeprom& eeprom) { eeprom.pointer = 2048; }, [](Eeprom& eeprom) { eeprom.phase = 5; },
      [](Eeprom& eeprom) { eeprom.bits = 10; },      [](Eeprom& eeprom) { eeprom.clock = 2; },
      [](Eeprom& eeprom) { eeprom.data = 2; },       [](Eeprom& eeprom) { eeprom.pulls = 2; }};
  for (const auto& spoil : spoilt)
    CHECK_THAT(refusal_of_chip(environment, spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Registers that CDFJ's chip can't have are refused") {
  using cdf::Chip;
  Environment environment = random_machine("CDFJ");
  const auto highest = [](Chip& chip) {
    chip.clock.voice.fill({0xFFFFFFFF, 0xFFFFFFFF});
    chip.clock.instructions = harmony::kMostInstructions;
    chip.clock.into_sample = harmony::kSampleParts - 1;
    chip.follower = {0x1FFF, 2, 0xFF};
    chip.wave.fill(31);
    chip.plays_waves = 1, chip.jump = 0x22, chip.stopped = 1, chip.loads = 3, chip.first_stream = 220;
  };
  CHECK(refusal_of_chip<Chip>(environment, highest).empty());
  const std::function<void(Chip&)> spoilt[] = {
      [](Chip& chip) { chip.clock.instructions = harmony::kMostInstructions + 1; },
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
    CHECK_THAT(refusal_of_chip(environment, spoil), Catch::Contains("has no such banks or registers"));
}

TEST_CASE("Cartridge RAM of another size is refused") {
  Environment environment = random_machine("E7");
  for (const int size : {0, 1024, 2047, 2049, 32768}) {
    Environment::Saved saved = *environment.save(true);
    saved.cartridge_ram.resize(static_cast<std::size_t>(size));
    CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                      Catch::Contains("bytes of cartridge RAM"));
  }
}

TEST_CASE("An impossible generator is refused") {
  Environment environment = test::steered();
  auto saved = *environment.save(true);
  saved.random = MersenneTwister(std::array<std::uint32_t, MersenneTwister::kWords>{}, 7);
  CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                    Catch::Contains("generator are all 0"));
  saved.random = MersenneTwister(MersenneTwister().words(), 625);
  CHECK_THROWS_WITH(from_bytes(to_bytes(saved, environment), environment),
                    Catch::Contains("position of the generator is 625; it must be from 0 to 624"));
}

}  // namespace
}  // namespace racebeam

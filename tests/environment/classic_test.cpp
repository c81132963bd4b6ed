// Seeding and resets as in ALE 0.4 to 0.6 (docs/spec/classic-protocol.md, 6).
#include <catch2/catch.hpp>

#include "environment/reset/classic_power_on.hpp"
#include "environment/saved_state.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam {
namespace {

Settings classic(std::uint32_t seed = 123) {
  Settings settings;
  settings.random_seed = seed;
  settings.classic = true;
  settings.sticky = 0;
  return settings;
}

Environment counter(const Settings& settings) { return {test::counter_image(), test::game(), settings}; }

bool has_drawn(const Environment& environment, unsigned draws) {
  MersenneTwister expected(environment.settings().random_seed);
  expected.discard(draws);
  return *environment.save(true)->random == expected;
}

TEST_CASE("Power-on RAM comes from the environment's own seed") {
  const Environment environment = counter(classic());
  MersenneTwister random(123);
  bool same = true;
  for (std::size_t i = 0; i < 128; ++i) {
    const auto byte = static_cast<std::uint8_t>(random());
    if (i >= 0x20 && i < 0x70)
      same = same && environment.ram()[i] == byte;  // the program clears the first 32
  }
  CHECK(same);
}

TEST_CASE("The generator starts again after construction; a reset takes a draw, an act's frame two") {
  Environment environment = counter(classic());
  CHECK(has_drawn(environment, 1));
  environment.act(3);
  CHECK(has_drawn(environment, 3));
  environment.reset_game();
  CHECK(has_drawn(environment, 4));
}

TEST_CASE("A reset keeps the stored action, unlike that of ALE 0.12") {
  for (const bool is_classic : {true, false}) {
    Settings settings = classic();
    settings.classic = is_classic;
    Environment environment = counter(settings);
    environment.act(14, 20);
    environment.reset_game();
    const Presses held = environment.save()->values.play.held;
    CHECK(held.a.action == (is_classic ? 14 : 0));
    CHECK(held.b.action == (is_classic ? 20 : 18));
  }
}

// Holds its frame open while RESET is held, so that it is unfinished after a reset.
std::shared_ptr<const Image> waiting_image() {
  constexpr std::uint8_t kProgram[] = {
      0xAD, 0x82, 0x02,  // F000 wait  LDA SWCHB
      0x4A,              // F003       LSR            RESET
      0x90, 0xFA,        // F004       BCC wait
      0xA9, 0x02,        // F006       LDA #2
      0x85, 0x00,        // F008       STA VSYNC
      0x85, 0x02,        // F00A       STA WSYNC
      0x85, 0x02,        // F00C       STA WSYNC
      0xE6, 0x80,        // F00E       INC $80
      0xA5, 0x80,        // F010       LDA $80
      0x85, 0x09,        // F012       STA COLUBK
      0xA9, 0x00,        // F014       LDA #0
      0x85, 0x91,        // F016       STA $91        the steered game is not over
      0x85, 0x00,        // F018       STA VSYNC      the frame closes here
      0xA2, 0x64,        // F01A       LDX #100       not all of the picture is drawn
      0x85, 0x02,        // F01C line  STA WSYNC
      0xCA,              // F01E       DEX
      0xD0, 0xFB,        // F01F       BNE line
      0x4C, 0x00, 0xF0,  // F021       JMP wait
  };
  std::vector<std::uint8_t> bytes(4096);
  std::ranges::copy(kProgram, bytes.begin());
  bytes[0xFFD] = 0xF0;  // the reset vector: $F000
  return make_image(std::move(bytes), "waiting");
}

TEST_CASE("How far a frame has come is not part of a state that the classic protocol loads") {
  Environment environment(waiting_image(), test::game(), classic());
  const auto progress = [&] {
    const State machine = environment.save()->values.machine;
    return std::pair(machine.frame.open, machine.tia.pixel);
  };
  const auto unfinished = environment.save();
  CHECK(progress().first == 1);
  for (int i = 0; i < 3; ++i) environment.act(0);
  const auto finished = environment.save();
  const auto whole = progress();
  CHECK(whole.first == 0);
  environment.restore_classic(*unfinished);
  CHECK(progress() == whole);
  environment.reset_game();
  const auto part = progress();
  CHECK(part.first == 1);
  CHECK(part.second != whole.second);
  environment.restore_classic(*finished);
  CHECK(progress() == part);
}

TEST_CASE("Cartridge RAM is filled once, by a generator with the default seed") {
  MersenneTwister shared(1), expected;
  const MersenneTwister untouched = shared;
  ClassicPowerOn power_on(shared);
  std::array<std::uint8_t, 128> ram{};
  std::uint32_t draws = 0;
  power_on.fill_cartridge(ram, draws);
  for (const std::uint8_t byte : ram) CHECK(byte == static_cast<std::uint8_t>(expected()));
  CHECK(shared == untouched);
  ram.fill(7);
  power_on.fill_cartridge(ram, draws);
  CHECK(std::ranges::all_of(ram, [](std::uint8_t byte) { return byte == 7; }));
}

TEST_CASE("A classic session plays the game that ALE 0.6 had, with corrected rules if it is told to") {
  constexpr int kSelect = 5, kReset = 6, kResetFrames = 4;  // how many frames these were held
  constexpr auto kVariants =
      "[classic]\nsingle_mode = true\nstart = ['UP', 'NOOP']\nlives = '7'\n"
      "[fixed]\nlives = '9'\nreference = 'r'\ncorrection = 'c'\nevidence = 'e'\n"
      "[mode]\nsetup = '''\nselect 5; soft_reset\n'''\n";
  const auto game = test::game(std::string(test::kSteeredGame) + kVariants);
  const auto machine = [&](bool is_classic, Rules rules) {
    Settings settings = classic();
    settings.classic = is_classic;
    settings.rules = rules;
    return Environment(test::counter_image(), game, settings);
  };
  const Environment now = machine(false, Rules::kAle012);
  CHECK(now.ram()[kSelect] == 5);
  for (const Rules rules : {Rules::kAle012, Rules::kFixed}) {
    Environment old = machine(true, rules);
    CHECK(old.ram()[kSelect] == 0);
    CHECK(old.ram()[kReset] == now.ram()[kReset] - kResetFrames);
    CHECK(old.lives() == (rules == Rules::kFixed ? 9 : 7));
    CHECK(old.game().starting_actions == std::vector<int>{2, 0});
    CHECK_THROWS_WITH(old.set_mode(1), "steered has no mode 1; it offers 0");
  }
}

}  // namespace
}  // namespace racebeam

// Paddles turned with any strength, as in ALE 0.12: checksums of 4,000 acts of ale-py 0.12.1, with sticky
// actions 0.25 and seed 123, in all its paddle games (docs/spec/environment.md, 2).
#include <array>
#include <catch2/catch.hpp>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"
#include "tests/support/crc.hpp"
#include "tests/support/needed_rom.hpp"

namespace racebeam {
namespace {

struct Run {
  const char* game;
  std::uint32_t all_ram, last_screen;
  int reward;
};

constexpr Run kRuns[] = {
    {"backgammon", 0x4676FA89, 0x9DAE6AE8, 0}, {"blackjack", 0xEFFA6594, 0xDD0C7004, -17},
    {"breakout", 0x5453C175, 0x7EE9CF0C, 8},   {"casino", 0x5562E426, 0x4C171BAC, -1030},
    {"kaboom", 0x68B4AB89, 0xAF56BE10, 20},    {"pong", 0x156C3E2D, 0x841B3190, -19},
};

constexpr int kActs = 4000, kHeld = 5;
constexpr std::array kTurns = {0, 3, 11, 4, 12, 1, 6, 7, 8, 9, 14, 15};

float strength(int act) { return static_cast<float>(act * 37 % 401 - 200) / 128; }

}  // namespace

TEST_CASE("strengths of paddles turn them as the reference does, of either sign and above 1") {
  for (const Run& run : kRuns) {
    const auto game = find_game(run.game);
    const auto image = test::needed_rom_of(run.game);
    if (!image) continue;
    INFO(run.game);
    Settings settings;
    settings.random_seed = 123;
    Environment environment(image, game, settings);
    int reward = 0;
    std::vector<std::uint8_t> all_ram;
    for (int i = 0; i < kActs; ++i) {
      reward += environment.act(kTurns[static_cast<std::size_t>(i / kHeld) % kTurns.size()], 18, strength(i));
      all_ram.insert(all_ram.end(), environment.ram().begin(), environment.ram().end());
      if (environment.game_over()) environment.reset_game();
    }
    CHECK(test::crc(all_ram) == run.all_ram);
    CHECK(test::crc(environment.screen()) == run.last_screen);
    CHECK(reward == run.reward);
  }
}

TEST_CASE("player B turns the second paddle, with B's own strength, and not at all without one") {
  const auto game = find_game("pong");
  const auto image = test::needed_rom_of("pong");
  if (!image) return;
  constexpr int kBatB = 0x84 - 0x80;  // where B's paddle was read
  Settings settings;
  settings.sticky = 0;
  Environment environment(image, game, settings);
  environment.set_mode(2);
  environment.reset_game();
  const auto turned = [&](float strength) {
    const auto start = environment.save();
    for (int i = 0; i < 6; ++i) environment.act(0, 21, 1, strength);
    const int position = environment.ram()[kBatB];
    environment.restore(*start);
    return position;
  };
  CHECK(turned(1) != turned(0));
  CHECK(turned(0.5F) != turned(1));
  CHECK(turned(-1) == turned(1));
}

}  // namespace racebeam

// Settings::rules, the second player's rewards, and our own rules on commercial images.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

#include <random>
#include <vector>

#include "environment/environment.hpp"
#include "games/catalogue.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/needed_rom.hpp"

namespace racebeam {
namespace {

constexpr auto kTwoPlayers = R"(
title = "Two"
modes = [0]
two_player_modes = [2]
[rule]
step = '''
score = ram[0x90]
score_b = ram[0x93]
terminal = ram[0x91] != 0
'''
[fixed]
wraps = 256
)";

Settings with(Rules rules) {
  Settings settings = test::plain();
  settings.rules = rules;
  return settings;
}

Environment two_players(const Settings& settings) {
  return {test::counter_image(), test::game(kTwoPlayers, "two"), settings};
}

Environment running(const std::shared_ptr<const Image>& image, const char* game, int mode) {
  Environment environment(image, find_game(game), with(Rules::kAle012));
  environment.set_mode(mode);
  environment.reset_game();
  return environment;
}

}  // namespace

TEST_CASE("with the fixed rules, games end by their clocks") {
  for (const auto& [name, last] :
       {std::pair{"pitfall", 72000}, {"breakout", 65536}, {"video_pinball", 65467}, {"basic_math", 8064}}) {
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    INFO(name);
    for (const Rules rules : {Rules::kAle012, Rules::kFixed}) {
      Environment environment(image, find_game(name), with(rules));
      environment.act(name == std::string("pitfall") ? 1 : 0);  // Pitfall's clock waits for the player
      environment.act_for(last - 200, 0);
      CHECK_FALSE(environment.terminal());
      environment.act_for(400, 0);
      CHECK(environment.terminal() == (rules == Rules::kFixed));
    }
  }
}

TEST_CASE("both players' rewards are summed over a skip and clipped alike") {
  Settings settings = test::plain();
  settings.frame_skip = 2;
  settings.reward_min = -5;
  settings.reward_max = 5;
  Environment environment = two_players(settings);
  environment.set_ram(0x10, 3);
  environment.set_ram(0x13, 9);
  CHECK(environment.act(0) == 3);
  CHECK(environment.rewards().a == 3);
  CHECK(environment.rewards().b == 5);
  const auto saved = environment.save();
  environment.act(0);
  CHECK(environment.rewards().b == 0);
  environment.restore(*saved);
  CHECK(environment.rewards().b == 5);
  environment.reset_game();
  CHECK(environment.rewards().b == 0);
}

TEST_CASE("the requested rules are in force; the default is ale-0.12") {
  for (const Rules rules : {Rules::kAle012, Rules::kFixed}) {
    Environment environment = two_players(with(rules));
    environment.set_ram(0x10, 255);
    environment.act(0);
    environment.set_ram(0x10, 4);
    CHECK(environment.act(0) == (rules == Rules::kFixed ? 5 : -251));
  }
  CHECK(Settings{}.rules == Rules::kAle012);
}

TEST_CASE("a state of other rules is refused") {
  Environment reference = two_players(with(Rules::kAle012)), mended = two_players(with(Rules::kFixed));
  CHECK_THROWS_WITH(mended.restore(*reference.save()),
                    "the state is of the game two; the one that runs is two with fixed rules");
}

TEST_CASE("modes for two players can be set, and a refusal names them too") {
  Environment environment = two_players(test::plain());
  environment.set_mode(2);
  CHECK_THROWS_WITH(environment.set_mode(1), "two has no mode 1; it offers 0, 2");
}

TEST_CASE("Klax counts across the wrap of a score in the cartridge's memory") {
  const auto reference = find_game("klax");
  REQUIRE(reference->fixed);
  std::array<std::uint8_t, 128> ram{};
  std::array<std::uint8_t, 3> digits{};
  const auto peek = [](const void* machine, std::uint16_t address) -> std::uint8_t {
    const auto& bytes = *static_cast<const std::array<std::uint8_t, 3>*>(machine);
    const int at = (address & 0x1FFF) - 0x10B4;
    return at >= 0 && at < 3 ? bytes[static_cast<std::size_t>(at)] : std::uint8_t{0};
  };
  Rule before(*reference), after(*reference->fixed);
  for (const std::array<std::uint8_t, 3> memory :
       {std::array<std::uint8_t, 3>{0, 0, 0x50}, {0x99, 0x99, 0x99}, {4, 0, 0}}) {
    digits = memory;
    before.step({ram.data(), peek, &digits});
    after.step({ram.data(), peek, &digits});
  }
  CHECK(before.reward() == 4 - 999999);
  CHECK(after.reward() == 5);
}

struct OurGame {
  const char* name;
  int address;             // of the mode in RAM
  int (*shown)(int mode);  // its expected value
};

TEST_CASE("every mode of our own rules is set up, in any order, and its game runs") {
  const OurGame kGames[] = {{"combat", 0x80, [](int mode) { return mode - 1; }},
                            {"joust", 0xF8, [](int mode) { return mode; }},
                            {"maze_craze", 0xBD, [](int mode) { return mode; }},
                            {"warlords", 0xD9, [](int mode) { return mode - 1; }}};
  for (const OurGame& one : kGames) {
    INFO(one.name);
    const auto image = test::needed_rom_of(one.name);
    if (!image) continue;
    Environment environment(image, find_game(one.name), test::plain());
    std::vector<int> modes = environment.game().offered_modes();
    std::shuffle(modes.begin(), modes.end(), std::mt19937{7});
    modes.resize(std::min<std::size_t>(modes.size(), 40));
    for (const int mode : modes) {
      INFO(mode);
      environment.set_mode(mode);
      environment.reset_game();
      CHECK(test::at(environment, one.address) == one.shown(mode));
      CHECK_FALSE(environment.game_over());
      CHECK(environment.lives() > 0);
      for (int i = 0; i < 60; ++i) CHECK(environment.act(0) == 0);
      CHECK_FALSE(environment.game_over());
    }
  }
}

struct Total {
  int a = 0, b = 0, frames = 0;
  bool over = false;
};

// Random play of both, each action held for `hold` frames.
Total play(Environment& environment, const std::vector<int>& actions, int hold, int frames) {
  std::mt19937 random(5);
  Total total;
  int a = 0, b = 18;
  for (; total.frames < frames && !total.over; ++total.frames) {
    if (total.frames % hold == 0) {
      a = actions[random() % actions.size()];
      b = actions[random() % actions.size()] + 18;
    }
    environment.act(a, b, 1, 1);
    total.a += environment.rewards().a;
    total.b += environment.rewards().b;
    total.over = environment.game_over();
  }
  return total;
}

const std::vector<int> kTank = {1, 2, 3, 4, 10, 11, 12}, kFlap = {0, 1, 1, 1, 3, 4, 11, 12};

TEST_CASE("Combat ends when its time is up, with the points of both on the screen") {
  const auto image = test::needed_rom_of("combat");
  if (!image) return;
  Environment environment = running(image, "combat", 14);
  const Total total = play(environment, kTank, 15, 9000);
  CHECK(total.over);
  CHECK((total.frames > 8000 && total.frames < 8300));
  const auto decimal = [&](int address) {
    return test::at(environment, address) / 16 * 10 + test::at(environment, address) % 16;
  };
  CHECK(decimal(0xA1) + decimal(0xA2) > 0);
  CHECK(total.a == decimal(0xA1) - decimal(0xA2));
  CHECK(total.b == -total.a);
}

TEST_CASE("Joust gives each player the own points and ends when both are out") {
  const auto image = test::needed_rom_of("joust");
  if (!image) return;
  for (const int mode : {0, 1}) {
    Environment environment = running(image, "joust", mode);
    CHECK(environment.lives() == 5);
    const Total total = play(environment, kFlap, 6, 30000);
    CHECK(total.over);
    CHECK(environment.lives() == 0);
    CHECK(total.a > 0);
    CHECK((total.b > 0) == (mode == 1));
  }
}

TEST_CASE("Warlords counts rounds won, and five of them are the match") {
  const auto image = test::needed_rom_of("warlords");
  if (!image) return;
  Environment environment = running(image, "warlords", 5);
  const Total total = play(environment, {0, 1, 3, 4, 11, 12}, 6, 120000);
  CHECK(total.over);
  CHECK(std::max(total.a, total.b) == 5);
  CHECK(std::min(total.a, total.b) < 5);
}

TEST_CASE("the player that leaves the maze wins: the other loses") {
  const auto image = test::needed_rom_of("maze_craze");
  if (!image) return;
  for (const int winner : {0xCE, 0xCF}) {
    Environment environment = running(image, "maze_craze", 0);
    environment.set_ram(winner - 0x80, 0x9C);  // in the exit's column
    environment.set_ram(0xBC - 0x80, 0x40);    // as after a race
    const int reward = environment.act(0);
    CHECK(environment.terminal());
    CHECK(reward == (winner == 0xCE ? 1 : -1));
    CHECK(environment.rewards().b == -reward);
  }
}

// Whether the screen depends on B's actions.
bool b_plays(Environment& environment, int right = 21, int left = 22) {
  const auto start = environment.save(true);
  std::vector<std::vector<std::uint8_t>> seen_first;
  for (int i = 0; i < 120; ++i) {
    environment.act(0, right, 1, 1);
    seen_first.emplace_back(environment.screen().begin(), environment.screen().end());
  }
  environment.restore(*start);
  bool is_seen = false;
  for (const auto& screen : seen_first) {
    environment.act(0, left, 1, 1);
    is_seen = is_seen || !std::ranges::equal(screen, environment.screen());
  }
  environment.restore(*start);
  return is_seen;
}

TEST_CASE("corrected lives begin with what a loss of life is measured against") {
  Settings settings = with(Rules::kFixed);
  settings.truncate_on_life_loss = true;
  for (const char* name :
       {"adventure", "bank_heist", "donkey_kong", "entombed", "frogger", "kaboom", "qbert"}) {
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    INFO(name);
    Environment environment(image, find_game(name), settings);
    CHECK_FALSE(environment.game_over());
    for (int i = 0; i < 30; ++i) environment.act(0);
    CHECK_FALSE(environment.game_over());
  }
}

TEST_CASE("in modes for two player B plays, and gets what A loses where that is the rule") {
  for (const char* name : {"pong", "boxing", "tennis", "ice_hockey", "surround"}) {
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    const auto game = find_game(name);
    Environment alone = running(image, name, 0);
    CHECK_FALSE((b_plays(alone) || b_plays(alone, 20, 23)));
    for (const int mode : game->two_player_modes) {
      INFO(name << " mode " << mode);
      Environment environment = running(image, name, mode);
      CHECK((b_plays(environment) || b_plays(environment, 20, 23)));
      const Total total = play(environment, kTank, 10, 1200);
      CHECK(total.b == -total.a);
    }
  }
}

}  // namespace racebeam

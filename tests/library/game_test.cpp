#include "racebeam/game.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/games/scratch.hpp"
#include "tests/library/beamfall.hpp"

using racebeam::Action;
using racebeam::Game;
using racebeam::Image;

TEST_CASE("Actions have the names and numbers of ALE") {
  CHECK(racebeam::name_of(Action::kNoop) == "NOOP");
  CHECK(racebeam::name_of(Action::kDownLeftFire) == "DOWNLEFTFIRE");
  for (int number = 0; number <= static_cast<int>(Action::kKeyHash); ++number) {
    const auto action = static_cast<Action>(number);
    CHECK(racebeam::action_named(racebeam::name_of(action)) == action);
  }
  CHECK(racebeam::name_of(Action::kBlackAndWhite) == "BW");
  CHECK(racebeam::name_of(Action::kKey7) == "KEY7");
  CHECK(racebeam::name_of(with(Action::kUpFire, racebeam::Buttons::kTriggerAndBooster)) ==
        "UPFIRE+TRIGGER+BOOSTER");
  CHECK_FALSE(racebeam::action_named("fire"));
}

TEST_CASE("An image has the name of its file, and its game is found by either") {
  const Image image = beamfall::image();
  CHECK(image.name() == "beamfall");
  CHECK(image.md5().size() == 32);
  CHECK(Game::recognise(image).name() == "beamfall");
  CHECK(Game::recognise(image).fits(image));
  const auto names = Image::built_in();
  CHECK(std::ranges::find(names, "updraft") != names.end());

  const Image renamed = Image::from_bytes(image.bytes(), "something");
  CHECK(Game::recognise(renamed).name() == "beamfall");
}

TEST_CASE("An image is read from a file") {
  const Image image = beamfall::image();
  const racebeam::Scratch scratch;
  const Image read = Image::load(scratch.write("My_Image.bin", {image.bytes().begin(), image.bytes().end()}));
  CHECK(read.md5() == image.md5());
  CHECK(read.name() == "my_image");
}

TEST_CASE("The image of an unknown game plays with all actions and without rewards") {
  const Image beamfall = beamfall::image();
  std::vector<std::uint8_t> bytes(beamfall.bytes().begin(), beamfall.bytes().end());
  bytes[0] ^= 1;
  const Image image = Image::from_bytes(bytes, "my_game");
  const Game game = Game::recognise(image);
  CHECK(game.name() == "my_game");
  CHECK_FALSE(game.has_rewards());
  CHECK(game.legal_actions().size() == 18);
}

TEST_CASE("A game file of the user gives an image its rewards") {
  const racebeam::Scratch scratch;
  const auto path = scratch.write(
      "my_game.toml", "title = 'My game'\n[rule]\nstep = \"\"\"\nscore = score + 7\nterminal = 0\n\"\"\"\n");
  const Game game = Game::load(path);
  CHECK(game.title() == "My game");
  CHECK(game.name() == "my_game");
  CHECK(game.has_rewards());
  racebeam::Environment environment(beamfall::image(), game);
  CHECK(environment.step(Action::kNoop) == 7);
  CHECK(environment.game().name() == "my_game");
}

TEST_CASE("The corrected rule of a game is played on request") {
  const racebeam::Scratch scratch;
  const auto path = scratch.write("my_game.toml", R"(
title = "My game"
[rule]
step = """
reward = 1
terminal = 0
"""
[fixed]
reference = "Rewards are too small."
correction = "They are larger."
evidence = "This test."
step = """
reward = 5
terminal = 0
"""
)");
  const Game game = Game::load(path);
  const auto reward = [&](racebeam::Rules rules) {
    racebeam::Settings settings = beamfall::settings();
    settings.frame_skip = 1;
    settings.rules = rules;
    return racebeam::Environment(beamfall::image(), game, settings).step(Action::kNoop);
  };
  CHECK(reward(racebeam::Rules::kAle012) == 1);
  CHECK(reward(racebeam::Rules::kFixed) == 5);
}

TEST_CASE("A game file that names controllers gives the players their actions") {
  const racebeam::Scratch scratch;
  const auto path = scratch.write("keys.toml",
                                  "title = 'Keys'\n[[image]]\nleft = 'keyboard'\nright = 'genesis'\n"
                                  "[rule]\nstep = \"\"\"\nscore = 0\nterminal = 0\n\"\"\"\n");
  racebeam::Environment environment(beamfall::image(), Game::load(path));
  const Action with_c = with(Action::kLeft, racebeam::Buttons::kC);
  CHECK_NOTHROW(environment.step(Action::kKey7, with_c));
  CHECK_NOTHROW(environment.step(Action::kReset));
  CHECK_THROWS_WITH(environment.step(with_c), Catch::Contains("player A has no action 68 (LEFT+C)"));
  CHECK_THROWS_WITH(environment.step(Action::kKey1, Action::kKey2),
                    Catch::Contains("player B has no action 27 (KEY2)"));
  auto joysticks = beamfall::environment();
  CHECK_THROWS_WITH(joysticks.step(Action::kKey7), Catch::Contains("player A has no action 32 (KEY7)"));
}

TEST_CASE("The games that the library knows are listed") {
  const auto names = Game::names();
  CHECK(std::ranges::is_sorted(names));
  CHECK(std::ranges::find(names, "breakout") != names.end());
  CHECK(Game::named("breakout").title() == "Breakout");
  CHECK_FALSE(Game::named("breakout").fits(beamfall::image()));
  CHECK(Game::named("breakout").minimal_actions().size() == 4);
  CHECK(Game::named("breakout").has_rewards());
}

TEST_CASE("The version is that of the headers") {
  CHECK(racebeam::version() == std::string(RACEBEAM_VERSION_STRING));
  CHECK(RACEBEAM_VERSION ==
        RACEBEAM_VERSION_MAJOR * 10000 + RACEBEAM_VERSION_MINOR * 100 + RACEBEAM_VERSION_PATCH);
}

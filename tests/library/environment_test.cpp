#include "racebeam/environment.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/games/scratch.hpp"
#include "tests/library/beamfall.hpp"
#include "tests/library/counter.hpp"

using racebeam::Action;
using racebeam::Environment;
using racebeam::Pixels;
using racebeam::Screens;

namespace {

std::vector<std::uint8_t> observed(Environment& environment, Pixels pixels) {
  std::vector<std::uint8_t> out(environment.observation_size(pixels));
  environment.observe(pixels, out);
  return out;
}

}  // namespace

TEST_CASE("A hundred steps of FIRE score what PROTOCOL.md says") {
  auto environment = beamfall::environment();
  CHECK(beamfall::score_of(environment, 100) == 82);
  CHECK(environment.episode_frames() == 400);
  CHECK(environment.frames() >= 400);
  CHECK(environment.lives() == 3);
  CHECK_FALSE(environment.episode_over());
  CHECK(environment.game().name() == "beamfall");
}

TEST_CASE("A reset with a seed repeats an episode, and one without continues the random numbers") {
  racebeam::Settings settings = beamfall::settings();
  settings.sticky = 0.5F;
  Environment environment(beamfall::image(), settings);
  const auto play = [&] {
    beamfall::score_of(environment, 50);
    return environment.state_hash();
  };
  environment.reset(3);
  const auto first = play();
  environment.reset();
  CHECK(play() != first);
  environment.reset(3);
  CHECK(play() == first);
}

TEST_CASE("All forms of a screen show the same picture") {
  auto environment = beamfall::environment();
  beamfall::score_of(environment, 10);
  const auto indices = observed(environment, Pixels::kPalette);
  const auto grey = observed(environment, Pixels::kGrey);
  const auto rgb = observed(environment, Pixels::kRgb);
  REQUIRE(indices.size() == static_cast<std::size_t>(environment.height() * racebeam::kScreenWidth));
  CHECK(std::ranges::equal(environment.screen(), indices));
  CHECK(grey.size() == indices.size());
  CHECK(rgb.size() == 3 * indices.size());
  const auto first = std::ranges::find_if(indices, [&](auto index) { return index != indices[0]; });
  REQUIRE(first != indices.end());
  const auto at = first - indices.begin();
  CHECK((rgb[3 * at] != rgb[0] || rgb[3 * at + 1] != rgb[1] || rgb[3 * at + 2] != rgb[2]));
}

TEST_CASE("A screen is the same whether it was announced or not") {
  racebeam::Settings settings = beamfall::settings();
  Environment announced(beamfall::image(), settings);
  settings.screens = Screens::kOnDemand;
  Environment on_demand(beamfall::image(), settings);
  for (int step = 0; step < 20; ++step) {
    announced.step(Action::kRight);
    on_demand.step(Action::kRight);
  }
  CHECK(std::ranges::equal(announced.screen(), on_demand.screen()));
  CHECK(std::ranges::equal(announced.previous_screen(), on_demand.previous_screen()));
}

TEST_CASE("A step takes its own number of frames, and both players") {
  auto environment = beamfall::environment();
  environment.step({.a = Action::kFire, .b = Action::kUp, .frames = 7});
  CHECK(environment.episode_frames() == 7);
  environment.step(Action::kFire, Action::kDownLeftFire);
  CHECK(environment.episode_frames() == 11);
}

TEST_CASE("A step lasts one frame where it asks for one, and those of the settings where it asks for 0") {
  auto environment = beamfall::environment();
  environment.step({.frames = 1});
  CHECK(environment.episode_frames() == 1);
  environment.step({.frames = 0});
  CHECK(environment.episode_frames() == 5);
}

TEST_CASE("Each player moves their own joystick, with the frames of the settings or of the step") {
  Environment environment(racebeam::Image::from_bytes(counter::bytes(), "counter"), beamfall::settings());
  const auto ports = [&](const racebeam::Controls& controls) {
    environment.step(controls);
    return int{environment.ram()[1]};  // a bit is 0 while its direction is held: player A's four, then B's
  };
  for (const int frames : {0, 3}) {
    CHECK(ports({.a = Action::kRight, .frames = frames}) == 0x7F);
    CHECK(ports({.b = Action::kRight, .frames = frames}) == 0xF7);
    CHECK(ports({.a = Action::kUp, .b = Action::kDownLeft, .frames = frames}) == 0xE9);
  }
}

TEST_CASE("Rewards are limited, and the raw ones are not") {
  racebeam::Settings settings = beamfall::settings();
  settings.reward_max = 1;
  settings.frame_skip = 60;
  Environment environment(beamfall::image(), settings);
  CHECK(environment.step(Action::kFire) == 1);
  CHECK(environment.rewards().a == 1);
  CHECK(environment.rewards().raw_a > 1);
  CHECK(environment.rewards().b == 0);
}

TEST_CASE("A limit of frames truncates an episode, whose steps then do nothing") {
  racebeam::Settings settings = beamfall::settings();
  settings.max_episode_frames = 8;
  Environment environment(beamfall::image(), settings);
  beamfall::score_of(environment, 3);
  CHECK(environment.truncated());
  CHECK_FALSE(environment.terminated());
  CHECK(environment.episode_over());
  CHECK(environment.episode_frames() == 8);
  CHECK(environment.step(Action::kFire) == 0);
  CHECK(environment.episode_frames() == 8);
  environment.reset();
  CHECK_FALSE(environment.episode_over());
}

TEST_CASE("A function is called after each frame, and its exception reaches the caller of step()") {
  auto environment = beamfall::environment();
  int frames = 0;
  environment.on_frame([&] { ++frames; });
  beamfall::score_of(environment, 5);
  CHECK(frames == 20);
  environment.on_frame([] { throw std::invalid_argument("the disk is full"); });
  CHECK_THROWS_AS(environment.step(Action::kNoop), std::invalid_argument);
  environment.on_frame(nullptr);
  environment.step(Action::kNoop);
}

TEST_CASE("RAM can be read and written, and sound is made on request") {
  racebeam::Settings settings = beamfall::settings();
  settings.sound = true;
  Environment environment(beamfall::image(), settings);
  environment.set_ram(5, 99);
  CHECK(environment.ram()[5] == 99);
  CHECK(environment.audio().size() == 512);
}

TEST_CASE("The first byte of RAM can be written, and the last") {
  auto environment = beamfall::environment();
  for (const int index : {0, racebeam::kRamSize - 1}) {
    environment.set_ram(index, 99);
    CHECK(environment.ram()[static_cast<std::size_t>(index)] == 99);
  }
}

TEST_CASE("An environment moves, and keeps what it shows") {
  auto environment = beamfall::environment();
  const int score = beamfall::score_of(environment, 50);
  Environment moved = std::move(environment);
  CHECK(score + beamfall::score_of(moved, 50) == 82);
}

namespace {

// A game with these modes. It looks for mode 1 at random, and does not reach it.
racebeam::Game game_with_modes(const std::string& modes) {
  const racebeam::Scratch scratch;
  const std::string rules = R"(
difficulties = [0, 3]
[rule]
step = """
score = 0
terminal = 0
"""
[mode]
setup = """
if mode == 1 {
  select 1 + (rng() & 1)
  fail "no such screen"
}
"""
)";
  return racebeam::Game::load(scratch.write("own.toml", "title = 'Own'\nmodes = " + modes + rules));
}

racebeam::Settings sticky_settings() {
  racebeam::Settings settings = beamfall::settings();
  settings.sticky = 0.5F;
  settings.seed = 3;
  return settings;
}

}  // namespace

TEST_CASE("A reset with a seed is a new environment with that seed, with the mode and the difficulty") {
  const auto game = game_with_modes("[0, 2]");
  Environment environment(beamfall::image(), game, beamfall::settings());
  beamfall::score_of(environment, 5);
  for (const int mode : {0, 2})
    for (const int difficulty : {0, 3}) {
      CAPTURE(mode, difficulty);
      environment.set_mode(mode);
      environment.set_difficulty(difficulty);
      environment.reset(3);
      Environment anew(beamfall::image(), game, beamfall::settings());
      if (mode != 0 || difficulty != 0) {
        anew.set_mode(mode);
        anew.set_difficulty(difficulty);
        anew.reset();
      }
      CHECK(environment.state_hash() == anew.state_hash());
      CHECK(environment.frames() == anew.frames());
      CHECK(std::ranges::equal(environment.ram(), anew.ram()));
    }
}

TEST_CASE("A reset that does not reach the mode changes nothing, with or without a seed") {
  const auto game = game_with_modes("[0, 1]");
  Environment environment(beamfall::image(), game, sticky_settings());
  Environment undisturbed(beamfall::image(), game, sticky_settings());
  for (auto* each : {&environment, &undisturbed}) {
    beamfall::score_of(*each, 30);
    each->set_mode(1);
  }
  CHECK_THROWS_AS(environment.reset(3), racebeam::Error);
  CHECK(environment.state_hash() == undisturbed.state_hash());
  CHECK(environment.frames() == undisturbed.frames());
  CHECK_THROWS_AS(environment.reset(), racebeam::Error);
  CHECK(environment.frames() == undisturbed.frames());
  for (auto* each : {&environment, &undisturbed})
    for (int step = 0; step < 40; ++step) each->step(step % 2 ? Action::kLeft : Action::kRight);
  CHECK(environment.state_hash() == undisturbed.state_hash());
}

TEST_CASE("A reset with a seed keeps the mode and the difficulty") {
  const racebeam::Scratch scratch;
  const auto file = scratch.write("own.toml",
                                  "title = 'Own'\nmodes = [0, 1]\ndifficulties = [0, 3]\n"
                                  "[rule]\nstep = \"\"\"\nscore = 0\nterminal = 0\n\"\"\"\n");
  Environment environment(beamfall::image(), racebeam::Game::load(file));
  const auto reset = [&] {
    environment.reset(3);
    return environment.state_hash();
  };
  const auto before = reset();
  environment.set_mode(1);
  const auto in_mode = reset();
  CHECK(in_mode != before);
  CHECK(reset() == in_mode);
  environment.set_difficulty(3);
  const auto with_difficulty = reset();
  CHECK(with_difficulty != in_mode);
  CHECK(reset() == with_difficulty);
}

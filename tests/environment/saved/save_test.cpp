// Saving and restoring in one process has no observable effect.
#include <catch2/catch.hpp>
#include <random>

#include "environment/saved/saved_state_format.hpp"
#include "environment/saved_state.hpp"
#include "tests/support/counter_image.hpp"
#include "tests/support/needed_rom.hpp"
#include "tests/support/observation.hpp"

namespace racebeam {
namespace {

using test::act;
using test::observe;
using Future = std::vector<test::Observation>;

Settings sticky_settings() {
  Settings settings;
  settings.random_seed = 7;
  settings.sound = true;
  return settings;
}

Future play(Environment& environment, int frames, unsigned seed) {
  std::mt19937 random(seed);
  const auto& legal = environment.game().legal_actions;
  Future future;
  for (int i = 0; i < frames; ++i) future.push_back(act(environment, legal[random() % legal.size()]));
  return future;
}

// Along a random run, every state can be restored: in this machine, in another one, and from bytes.
void check_identity_of_states(const std::shared_ptr<const Image>& image,
                              const std::shared_ptr<const Game>& game, Settings settings, int frames,
                              int stride) {
  INFO(game->name);
  Environment running(image, game, settings), other(image, game, settings);
  for (int i = 0; i < frames; ++i) {
    play(running, stride, static_cast<unsigned>(i));
    const auto saved = running.save(true);
    const auto observation = observe(running);
    const Future future = play(running, 4, 1000u + static_cast<unsigned>(i));
    running.restore(*saved);
    REQUIRE(observe(running) == observation);
    REQUIRE(play(running, 4, 1000u + static_cast<unsigned>(i)) == future);
    other.restore(*from_bytes(to_bytes(*saved, running), other));
    REQUIRE(observe(other) == observation);
    REQUIRE(play(other, 4, 1000u + static_cast<unsigned>(i)) == future);
    running.restore(*saved);
  }
  Environment fresh(image, game, settings);
  const auto bytes = to_bytes(*running.save(true), running);
  const Future future = play(running, 300, 1);
  fresh.restore(*from_bytes(bytes, fresh));
  REQUIRE(play(fresh, 300, 1) == future);
}

// Reward, lives and the end change from frame to frame.
constexpr auto kLivelyGame = R"(
title = "Lively"
[rule]
step = '''
score    = ram[0x80] * ram[0x80]
lives    = 9 - ram[0x80] / 16
terminal = ram[0x80] == 150
'''
)";

TEST_CASE("Every state of a run restores to itself, also with averaging and skipped frames") {
  Settings settings = sticky_settings();
  const auto game = test::game(kLivelyGame, "lively");
  check_identity_of_states(test::counter_image(), game, settings, 60, 1);
  settings.color_averaging = true;
  settings.frame_skip = 3;
  check_identity_of_states(test::counter_image(), game, settings, 20, 2);
  settings.classic = true;
  check_identity_of_states(test::counter_image(), game, settings, 20, 2);
}

// Plain games, paddles, unfinished frames, E0, FE, on-board RAM, PAL, and the game whose missiles the
// reference forgets.
TEST_CASE("Every state of a run of a commercial game restores to itself") {
  constexpr const char* kGames[] = {"seaquest", "breakout",        "tetris", "montezuma_revenge",
                                    "robotank", "elevator_action", "skiing", "yars_revenge",
                                    "freeway",  "berzerk"};
  for (const char* name : kGames) {
    const auto game = find_game(name);
    const auto image = test::needed_rom_of(name);
    if (!image) continue;
    Settings settings = sticky_settings();
    check_identity_of_states(image, game, settings, 100, 1);
    settings.color_averaging = true;
    check_identity_of_states(image, game, settings, 20, 7);
  }
}

TEST_CASE("Without its generator, a restored state continues with the current one") {
  Settings settings = sticky_settings();
  settings.sticky = 0.5F;
  Environment environment(test::counter_image(), test::game(), settings);
  const auto saved = environment.save();
  CHECK_FALSE(saved->random);
  const Future once = play(environment, 40, 5);
  environment.restore(*saved);
  CHECK(play(environment, 40, 5) != once);
}

TEST_CASE("Mode, difficulty, counters and the held action come back") {
  Environment environment(test::counter_image(), test::game(), sticky_settings());
  environment.set_mode(3);
  environment.set_difficulty(2);
  play(environment, 10, 3);
  const auto saved = environment.save();
  environment.set_mode(1);
  environment.set_difficulty(1);
  play(environment, 10, 4);
  environment.restore(*saved);
  CHECK(environment.mode() == 3);
  CHECK(environment.difficulty() == 2);
  CHECK(environment.frame_number() == 10);
  CHECK(environment.save()->values.play.held.a.action == saved->values.play.held.a.action);
}

TEST_CASE("A state of another image or game is refused and changes nothing") {
  Environment environment(test::counter_image(), test::game(), sticky_settings());
  Environment named(test::counter_image(), test::game(test::kSteeredGame, "other"), sticky_settings());
  CHECK_THROWS_WITH(environment.restore(*named.save()),
                    "the state is of the game other; the one that runs is steered");

  auto image = std::make_shared<Image>(*test::counter_image());
  image->md5 = "0123456789abcdef0123456789abcdef";
  Environment changed(image, test::game(), sticky_settings());
  CHECK_THROWS_WITH(environment.restore(*changed.save()),
                    Catch::Contains("MD5 0123456789abcdef0123456789abcdef"));

  const std::string taller =
      "title = \"T\"\n[[image]]\nheight = 230\n[rule]\nstep = '''\nscore = 0\nterminal = 0\n'''\n";
  Environment tall(test::counter_image(), test::game(taller), sticky_settings());
  CHECK_THROWS_WITH(environment.restore(*tall.save()), Catch::Contains("another picture"));
  CHECK(environment.frame_number() == 0);
}

TEST_CASE("A state without pictures is the same from the next frame on") {
  Settings settings = sticky_settings();
  settings.sticky = 0;
  Environment running(test::counter_image(), test::game(), settings),
      other(test::counter_image(), test::game(), settings);
  for (unsigned run = 0; run < 20; ++run) {
    play(running, 7, run);
    const auto whole = running.save(), small = running.save_without_pictures();
    CHECK_FALSE(small->pictures.current);
    CHECK(small->state_hash() == whole->state_hash());
    running.set_drawing(run % 2 == 0 ? Drawing::kNone : Drawing::kEvery);
    play(running, 3, run + 100);
    running.restore(*small);
    other.restore(*whole);
    CHECK(running.state_hash() == other.state_hash());
    running.set_drawing(Drawing::kEvery);
    CHECK(play(running, 6, run + 200) == play(other, 6, run + 200));
  }
}

TEST_CASE("A classic restore answers the old screen and RAM until a frame runs") {
  Environment environment(test::counter_image(), test::game(), sticky_settings());
  play(environment, 5, 1);
  const auto saved = environment.save();
  const auto then = observe(environment);
  play(environment, 20, 2);
  environment.set_ram(0x11, 1);
  environment.act(0);
  REQUIRE(environment.terminal());
  const auto held = environment.save()->values.play.held.a.action;
  const auto now = observe(environment);

  environment.restore_classic(*saved);
  CHECK(observe(environment).screen == now.screen);
  CHECK(observe(environment).ram == now.ram);
  CHECK(observe(environment).audio == now.audio);
  CHECK_FALSE(environment.terminal());
  CHECK(environment.frame_number() == 5);
  CHECK(environment.save()->values.play.held.a.action == held);

  environment.restore_classic(*saved);  // again: still the RAM of before the first restore
  CHECK(observe(environment).ram == now.ram);
  environment.act(0);
  CHECK(environment.ram()[0] == then.ram[0] + 1);
}

TEST_CASE("A state saved while old RAM is answered shows that RAM when it is restored") {
  Environment environment(test::counter_image(), test::game(), sticky_settings());
  const auto start = environment.save();
  play(environment, 20, 2);
  environment.restore_classic(*start);
  const auto observation = observe(environment);
  const auto saved = environment.save();
  const Future future = play(environment, 3, 9);
  environment.reset_game();
  environment.restore(*saved);
  CHECK(observe(environment) == observation);
  environment.set_ram(0x7F, 0xA5);
  CHECK(environment.ram()[0x7F] == 0xA5);
}

}  // namespace
}  // namespace racebeam

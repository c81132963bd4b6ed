// Resets between episodes (docs/spec/environment.md, 7).
#include <catch2/catch.hpp>

#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

using test::at;
using test::counted;
using test::counter_image;
using test::draws;
using test::game;
using test::plain;
using test::steered;

TEST_CASE("A reset is 60 frames of NOOP and twice 4 frames of RESET, which are not counted") {
  Environment environment = steered();
  CHECK(at(environment, 0x80) == counted(68));
  CHECK(at(environment, 0x86) == 8);
  CHECK(environment.frame_number() == 0);
  CHECK(environment.episode_frame_number() == 0);
  CHECK(draws(environment) == 0);
  environment.act(0);
  environment.reset_game();
  CHECK(at(environment, 0x80) == counted(68));
  CHECK(environment.frame_number() == 1);
  CHECK(environment.episode_frame_number() == 0);
}

TEST_CASE("Starting actions take one frame each, and neither count nor draw") {
  const Environment environment(
      counter_image(),
      game(
          "title = \"S\"\nstart = [\"UP\", \"RESET 2\"]\n[rule]\nstep = '''\nscore = 0\nterminal = 0\n'''\n"),
      plain());
  CHECK(at(environment, 0x80) == counted(71));
  CHECK(at(environment, 0x86) == 10);
  CHECK(environment.frame_number() == 0);
  CHECK(draws(environment) == 0);
}

TEST_CASE("A mode program presses SELECT, and the frame after it counts") {
  const auto with_modes = game(R"(
title = "M"
modes = [0, 2]
[rule]
step = '''
score = 0
terminal = 0
seen = prev(seen) + 1
lives = seen
'''
[mode]
setup = '''
while ram[0x85] < 3 * mode { select 3 }
'''
)");
  Environment environment(counter_image(), with_modes, plain());
  CHECK(environment.lives() == 4);  // frames since the rule's reset
  environment.set_mode(2);
  CHECK(at(environment, 0x85) == 0);  // takes effect at the next reset
  environment.reset_game();
  CHECK(at(environment, 0x85) == 6);
  CHECK(at(environment, 0x80) == counted(68 + 2 * 4));
  CHECK(environment.lives() == 2 + 4);  // the rule does not see SELECT frames
  CHECK(environment.frame_number() == 2);
  CHECK(environment.episode_frame_number() == 2);
  CHECK(environment.mode() == 2);
}

TEST_CASE("An act in a mode program is a real one") {
  Settings settings = plain();
  settings.frame_skip = 3;
  const Environment environment(counter_image(),
                                game("title = \"A\"\n[rule]\nstep = '''\nscore = 0\nterminal = "
                                     "0\n'''\n[mode]\nsetup = '''\nact UP 2\nx = rng()\n'''\n"),
                                settings);
  CHECK(environment.frame_number() == 6);
  CHECK(at(environment, 0x80) == counted(68 + 6));
  CHECK(draws(environment) == 13);
}

TEST_CASE("A reset centres the paddles") {
  Environment environment(counter_image(), game("title = \"P\"\n[[image]]\nleft = \"paddles\"\n"), plain());
  const auto paddles = [&] { return environment.save()->values.machine.inputs.paddle; };
  environment.act(3, 18 + 4, 1.0F, 1.0F);
  CHECK(paddles() == std::array{385823, 431823, 0, 0});
  environment.reset_game();
  CHECK(paddles() == std::array{408823, 408823, 0, 0});
}

}  // namespace
}  // namespace racebeam

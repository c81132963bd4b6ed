#include <catch2/catch.hpp>

#include "games/catalogue.hpp"
#include "games/game/mode_program.hpp"
#include "tests/games/game_text.hpp"

using namespace racebeam;
using Catch::Contains;

namespace {

// Records its calls; SELECT increments the byte at $80.
struct FakeHost : ModeHost {
  FakeMemory bytes;
  std::string log;
  std::uint32_t next_random = 0;
  Rule* rule = nullptr;  // run after a soft reset, as an environment does

  Memory memory() override { return bytes.memory(); }
  void select(int frames) override {
    ++bytes[0x80];
    log += "select " + std::to_string(frames) + "; ";
  }
  void act(int action, int count) override {
    log += "act " + std::to_string(action) + " " + std::to_string(count) + "; ";
  }
  void soft_reset() override {
    log += "reset; ";
    if (rule) rule->step(memory());
  }
  std::uint32_t random() override { return ++next_random; }
};

const std::string kRule = "[rule]\nstep = '''\nreward = 0\nterminal = 0\nn = n\nlives = 10 * n\n'''\n";

Game game_with_setup(const std::string& setup) {
  return game_with(kRule + "[mode]\nsetup = '''\n" + setup + "\n'''");
}

std::string run(const std::string& setup, int mode) {
  const Game game = game_with_setup(setup);
  Rule rule(game);
  FakeHost host;
  run_mode_program(game, rule, mode, host);
  return host.log;
}

std::string error_of(const std::string& setup) {
  try {
    game_with_setup(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a mode program presses SELECT until memory shows the mode") {
  CHECK(run("while ram[0x80] != mode { select 2 }\nsoft_reset", 3) ==
        "select 2; select 2; select 2; reset; ");
  CHECK(run("while ram[0x80] != mode { select 2 }\nsoft_reset", 0) == "reset; ");
}

TEST_CASE("actions are done once, or as often as the program says") {
  CHECK(run("act UPFIRE; act NOOP 20\nact RIGHT 1 + mode", 4) == "act 10 1; act 0 20; act 3 5; ");
}

TEST_CASE("if takes one of two ways, and ways can be nested") {
  const std::string setup =
      "if mode & 1 {\n  if mode & 2 { select 3 } else { select 1 }\n} else {\n  select 9\n}";
  CHECK(run(setup, 3) == "select 3; ");
  CHECK(run(setup, 1) == "select 1; ");
  CHECK(run(setup, 2) == "select 9; ");
  CHECK(run("if mode { select 1 }", 0).empty());
}

TEST_CASE("a mode program has its own variables and can set those of the rule") {
  CHECK(run("wanted = mode + 1\nwanted = wanted * 2\nselect wanted", 2) == "select 6; ");
  const Game game = game_with_setup("n = mode");
  Rule rule(game);
  FakeHost host;
  run_mode_program(game, rule, 7, host);
  rule.step(host.memory());
  CHECK(rule.lives() == 70);
}

TEST_CASE("variables of the rule change under a mode program while frames pass") {
  const Game game = game_with_setup("n = 4\nsoft_reset\nselect lives + n");
  Rule rule(game);
  FakeHost host;
  host.rule = &rule;
  run_mode_program(game, rule, 0, host);
  CHECK(host.log == "reset; select 44; ");
}

TEST_CASE("rng draws once each time that its expression is evaluated") {
  CHECK(run("while ram[0x80] != 3 { select 10 + rng() }\nselect rng()", 0) ==
        "select 11; select 12; select 13; select 4; ");
}

TEST_CASE("a mode program that does not end is stopped, with an error that names game and mode") {
  const Game game = game_with_setup("while 1 { act NOOP }");
  Rule rule(game);
  FakeHost host;
  CHECK_THROWS_WITH(run_mode_program(game, rule, 5, host),
                    Contains("mode 5 of test could not be set up on this image"));
  CHECK(host.log.size() == std::string("act 0 1; ").size() * kModeTurns);
}

TEST_CASE("a mode program that asks for too many frames is stopped before it runs them") {
  for (const std::string setup :
       {"select 2000000000", "act NOOP 20001", "while 1 { select 9000\nact NOOP 9000 }"}) {
    const Game game = game_with_setup(setup);
    Rule rule(game);
    FakeHost host;
    CHECK_THROWS_WITH(run_mode_program(game, rule, 5, host), Contains("more than 20000 frames and acts"));
    CHECK(host.log.size() <= std::string("select 9000; act 0 9000; ").size());
  }
  CHECK(run("select 9000\nact NOOP 11000", 1) == "select 9000; act 0 11000; ");
  CHECK(run("select 20000\nact NOOP 0", 1) == "select 20000; act 0 0; ");
  CHECK_THROWS_WITH(run("select 0 - 5\nselect 20001", 1), Contains("more than 20000 frames and acts"));
}

TEST_CASE("an empty loop that does not end is stopped, too") {
  const Game game = game_with_setup("while 1 { while 0 { } }");
  Rule rule(game);
  FakeHost host;
  CHECK_THROWS_AS(run_mode_program(game, rule, 5, host), std::invalid_argument);
}

TEST_CASE("fail gives up with its text") {
  const Game game = game_with_setup("fail \"no such screen\"");
  Rule rule(game);
  FakeHost host;
  CHECK_THROWS_WITH(run_mode_program(game, rule, 1, host), Catch::EndsWith(": no such screen"));
}

TEST_CASE("a game without a mode program does nothing") {
  const Game game = game_with(kRule);
  Rule rule(game);
  FakeHost host;
  run_mode_program(game, rule, 0, host);
  CHECK(host.log.empty());
}

TEST_CASE("Adventure's mode program holds SELECT for a random time, then waits an action") {
  const auto game = find_game("adventure");
  Rule rule(*game);
  struct AdventureHost : FakeHost {
    void select(int frames) override {
      bytes[0xDD] = static_cast<std::uint8_t>(bytes[0xDD] + 2);
      log += "select " + std::to_string(frames) + "; ";
    }
  } host;
  run_mode_program(*game, rule, 2, host);
  CHECK(host.log == "select 3; act 0 1; select 4; act 0 1; reset; ");
}

TEST_CASE("an invalid mode program is refused with file, line and field") {
  // The first line of a program is line 12 of these files.
  CHECK_THAT(error_of("select"), Contains("test.toml:11: mode.setup: expected a value"));
  CHECK_THAT(error_of("soft_reset\nact JUMP"), Contains("test.toml:12: mode.setup: 'JUMP' is not an action"));
  CHECK_THAT(error_of("act RESET"), Contains("'RESET' is not an action"));
  CHECK_THAT(error_of("while 1 { select 1"), Contains("expected '}'"));
  CHECK_THAT(error_of("while 1\nselect 1"), Contains("expected '{'"));
  CHECK_THAT(error_of("}"), Contains("'}' without '{'"));
  CHECK_THAT(error_of("press 3"), Contains("expected a statement") && Contains("'press'"));
  CHECK_THAT(error_of("select wanted"), Contains("nothing assigns 'wanted'"));
  CHECK_THAT(error_of("select prev(n)"), Contains("prev()"));
  CHECK_THAT(error_of("select rng() + rng()"), Contains("once"));
  CHECK_THAT(error_of("mode = 3"), Contains("'mode' is a word of the rule language"));
  CHECK_THAT(error_of("fail"), Contains("text"));
  CHECK_THAT(error_of("fail \"half"), Contains("text must end"));
  CHECK_THAT(error_of("soft_reset soft_reset"), Contains("end of the line"));
}

TEST_CASE("a mode program may nest 50 blocks, and have 14 variables of its own") {
  const auto nested = [](int levels) {
    std::string text;
    for (int i = 0; i < levels; ++i) text += "if 1 { ";
    return text + "select 1" + std::string(static_cast<std::size_t>(levels), '}');
  };
  CHECK(run(nested(50), 0) == "select 1; ");
  CHECK(run(nested(50) + '\n' + nested(50), 0) == "select 1; select 1; ");
  for (const int levels : {51, 10000}) CHECK_THAT(error_of(nested(levels)), Contains("nested too deeply"));
  const auto with_variables = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "v" + std::to_string(i) + " = " + std::to_string(i) + "\n";
    return text + "v0 = 100\nselect v0 + v" + std::to_string(count - 1);
  };
  CHECK(run(with_variables(14), 0) == "select 113; ");
  CHECK_THAT(error_of(with_variables(15)), Contains("too many variables"));
}

TEST_CASE("a text may be empty, and ends on its line") {
  CHECK(error_of("if mode == 1 { fail \"\"}").empty());
  CHECK_THAT(error_of("fail \"\nsoft_reset \""), Contains("a text must end with \" on its line"));
}

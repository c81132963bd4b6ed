#include <catch2/catch.hpp>

#include "games/catalogue.hpp"
#include "tests/games/game_text.hpp"
#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Contains;
using Catch::Equals;

namespace {

const std::string kStep = "step = '''\nscore = ram[0x80]\nterminal = 0\n'''\n";

std::string error_of(const std::string& text) {
  try {
    parse_game(text, "test", "my.toml");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string error_in(const std::string& lines) { return error_of("title = 'T'\n" + lines); }

}  // namespace

TEST_CASE("a game file gives all facts of a game") {
  const Game game = parse_game(R"(
title        = "My Game"
legal        = ["NOOP", "LEFT", "RIGHT", "FIRE"]
minimal      = ["RIGHT", "NOOP"]
start        = ["FIRE", "NOOP 3", "RESET"]
modes        = [5, "1-3"]
default_mode = 2
difficulties = ["0-3"]
paddle_max   = 800000

[[image]]
md5              = "0123456789abcdef0123456789abcdef"
left             = "paddles"
right            = "driving"
swap_ports       = true
swap_paddles     = true
left_difficulty  = "A"
right_difficulty = "B"
hmove_blanks     = false
format           = "SECAM"
ystart           = 20
height           = 220

[[image]]
accepted         = false
left_difficulty  = "B"
right_difficulty = "A"
ystart           = 40
)",
                               "mine", "mine.toml");
  CHECK(game.name == "mine");
  CHECK(game.title == "My Game");
  CHECK(game.legal_actions == std::vector<int>{0, 1, 3, 4});
  CHECK(game.minimal_actions == std::vector<int>{0, 3});
  CHECK(game.starting_actions == std::vector<int>{1, 0, 0, 0, kResetAction});
  CHECK(game.modes == std::vector<int>{5, 1, 2, 3});
  CHECK(game.default_mode == 2);
  CHECK(game.difficulties == std::vector<int>{0, 1, 2, 3});
  CHECK(game.paddle_max == 800000);
  CHECK_FALSE(game.has_rule());
  const std::string md5 = "0123456789abcdef0123456789abcdef";
  CHECK(game.properties_for(md5) == Properties{.left = Controller::kPaddles,
                                               .right = Controller::kDriving,
                                               .swap_ports = true,
                                               .swap_paddles = true,
                                               .left_difficulty_a = true,
                                               .hmove_blanks = false,
                                               .format = Format::kSecam,
                                               .ystart = 20,
                                               .height = 220});
  CHECK(game.properties_for("another") == Properties{.right_difficulty_a = true, .ystart = 40});
  CHECK(game.accepts(md5));
  CHECK_FALSE(game.accepts("another"));
}

TEST_CASE("what a game file leaves out has its default") {
  const Game game = game_with("legal = ['NOOP', 'FIRE']");
  CHECK(game.minimal_actions == std::vector<int>{0, 1});
  CHECK(game.starting_actions.empty());
  CHECK(game.modes == std::vector<int>{0});
  CHECK(game.difficulties == std::vector<int>{0});
  CHECK(game.paddle_max == -1);
  CHECK(game.properties_for("any") == Properties{});
  CHECK(game.accepts("any"));
}

TEST_CASE("an image's cartridge scheme can be asked for, and two dumps always have theirs") {
  CHECK(game_with("[[image]]\nscheme = '3F'").properties_for("any").scheme == "3F");
  CHECK_THAT(error_in("[[image]]\nscheme = 'F9'"),
             Contains("my.toml:3: image.scheme: unknown cartridge scheme 'F9'") && Contains("F8 swapped"));
  for (const std::string name : {"GL", "BUS", "ELF", "CTY"})
    CHECK_THAT(error_in("[[image]]\nscheme = '" + name + "'"),
               Contains("my.toml:3: image.scheme: unsupported cartridge scheme '" + name + "'"));
  for (const char* md5 : {"bc24440b59092559a1ec26055fd1270e", "75ee371ccfc4f43e7d9b8f24e1266b55"})
    CHECK(game_with("").properties_for(md5).scheme == "F8 swapped");
  CHECK(game_with("").properties_for("any").scheme.empty());
}

TEST_CASE("errors name the file, the line and the field") {
  CHECK_THAT(error_of(""), Equals("my.toml:1: title: a game must have this key"));
  CHECK_THAT(error_in("titel = 'T'"), Contains("my.toml:2: titel: unknown key"));
  CHECK_THAT(error_in("\nmodes = 3"), Contains("my.toml:3: modes: must be a list"));
  CHECK_THAT(error_in("modes = [0,\n 1,\n 'x']"), Contains("my.toml:4: modes: must be numbers"));
  CHECK_THAT(error_in("[[image]]\nmd5 = 'ABC'"), Contains("my.toml:3: image.md5: must be 32"));
  CHECK_THAT(error_in("[[image]]\nheigth = 3"), Contains("my.toml:3: image.heigth: unknown key"));
  CHECK_THAT(error_in("[rule]\n"), Contains("my.toml:2: rule.step: a rule must have this key"));
  CHECK_THAT(error_in("[rule]\nstep = 3"), Contains("my.toml:3: rule.step: must be a text"));
  CHECK_THAT(error_in("a = [1,"), Contains("my.toml:2: TOML: "));
  CHECK_THAT(error_in("title = 'again'"), Contains("my.toml:2: TOML: "));
}

// Assertions of toml++ 3.3 do not hold for these.
TEST_CASE("tables without a name are refused like other mistakes, in every build") {
  for (const char* table : {"[[.a]]", "[[[a]]]", "[[=", "[.]"}) {
    CHECK_THAT(error_of(table), Contains("my.toml:1: "));
  }
}

TEST_CASE("errors within a text of several lines name its own line") {
  CHECK_THAT(error_in("[rule]\nstep = '''\nscore = 1\nterminal = nobody\n'''"),
             Contains("my.toml:5: rule.step: nothing assigns 'nobody'"));
  CHECK_THAT(error_in("[rule]\nstep = \"\"\"\nscore = 1\nterminal = nobody\n\"\"\""),
             Contains("my.toml:5: rule.step"));
  CHECK_THAT(error_in("[rule]\nstep = '''score = 1\nterminal = nobody'''"), Contains("my.toml:4: rule.step"));
  CHECK_THAT(error_in("[rule]\r\nstep = '''\r\nscore = 1\r\nterminal = nobody\r\n'''"),
             Contains("my.toml:5: rule.step"));
  CHECK_THAT(error_in("[rule]\n" + kStep + "lives = '3 + nobody'"),
             Contains("my.toml:7: rule.lives: nothing assigns 'nobody'"));
}

TEST_CASE("rules that cannot work are refused") {
  CHECK_THAT(error_in("[rule]\nstep = 'score = 1'"), Contains("nothing assigns 'terminal'"));
  CHECK_THAT(error_in("[rule]\nstep = 'terminal = 1'"), Contains("nothing assigns 'score' or 'reward'"));
  CHECK_THAT(error_in("[rule]\nstep = ''"), Contains("my.toml:3: rule.step"));
  CHECK_THAT(error_in("[rule]\n" + kStep + "lives = 'ram[0x80]'"),
             Contains("rule.lives: memory can be read in 'step' only"));
  CHECK_THAT(error_in("[rule]\n" + kStep + "terminal = 'prev(score)'"),
             Contains("rule.terminal: prev() is only accepted in 'step'"));
  CHECK_THAT(error_in("[rule]\n" + kStep + "terminal = '1 2'"), Contains("end of the expression"));
  CHECK_THAT(error_in("[rule]\nreset = { live = 3 }\n" + kStep),
             Contains("my.toml:3: rule.reset.live: the step never reads"));
  CHECK_THAT(error_in("[rule]\nreset = { if = 3 }\n" + kStep), Contains("rule.reset.if: 'if' is a word"));
  CHECK_THAT(error_in("[rule]\nreset = { score = 'x' }\n" + kStep),
             Contains("rule.reset.score: must be a whole number"));
  CHECK_THAT(error_in("[rule]\nreset = { score = 3000000000 }\n" + kStep),
             Contains("3000000000 is out of range; accepted: -2147483648 to 2147483647"));
  CHECK_THAT(error_in("[rule]\nreset = 3\n" + kStep), Contains("rule.reset: must be a table"));
  CHECK_THAT(error_in("[rule]\nkeep = [3]\n" + kStep), Contains("my.toml:3: rule.keep: '' is not a name"));
  CHECK_THAT(error_in("[rule]\nkeep = ['scroe']\n" + kStep),
             Contains("my.toml:3: rule.keep: the step never reads"));
  CHECK_THAT(error_in("[mode]\nsetup = 'soft_reset'"), Contains("mode: a mode program requires a [rule]"));
  const auto with_variables = [](int count) {  // that persist, besides reward, terminal and score
    std::string text = "[rule]\nstep = '''\nscore = 0\nterminal = 0\n";
    for (int i = 0; i < count; ++i) {
      const std::string name = "v" + std::to_string(i);
      text.append(name).append(" = prev(").append(name).append(")\n");
    }
    return text + "'''";
  };
  CHECK(error_in(with_variables(13)).empty());
  CHECK_THAT(error_in(with_variables(14)), Contains("more than 16 variables"));
}

TEST_CASE("facts that cannot be are refused") {
  CHECK_THAT(error_in("minimal = ['JUMP']"), Contains("minimal: must be names of actions"));
  CHECK_THAT(error_in("minimal = ['FIRE', 'FIRE']"), Contains("FIRE is listed twice"));
  CHECK_THAT(error_in("minimal = []"), Contains("must not be empty"));
  CHECK_THAT(error_in("minimal = [1]"), Contains("minimal: must be names"));
  CHECK_THAT(error_in("legal = ['NOOP']\nminimal = ['FIRE']"), Contains("minimal: must be legal actions"));
  CHECK_THAT(error_in("minimal = ['RESET']"), Contains("minimal: must be names"));
  CHECK_THAT(error_in("start = ['FIRE 0']"), Contains("start: must be actions"));
  CHECK_THAT(error_in("start = ['FIRE x']"), Contains("start: must be actions"));
  CHECK_THAT(error_in("start = ['FIRE 1000000000']"), Contains("start: must be actions"));
  CHECK_THAT(error_in("start = ['FIRE 100001']"), Contains("start: must be actions"));
  CHECK_THAT(error_in("start = ['FIRE 60000', 'NOOP 40001']"),
             Contains("start: must be 100000 actions at most"));
  CHECK_THAT(error_in("start = ['SELECT']"), Contains("start: must be actions"));
  CHECK_THAT(error_in("modes = ['7-3']"), Contains("modes: must be numbers"));
  CHECK_THAT(error_in("modes = [-1]"), Contains("modes: must be numbers"));
  CHECK_THAT(error_in("modes = [65536]"), Contains("modes: must be numbers from 0 to 65535"));
  CHECK_THAT(error_in("modes = []"), Contains("modes: must not be empty"));
  CHECK_THAT(error_in("modes = ['0-2000000000']"), Contains("modes: must be numbers"));
  CHECK_THAT(error_in("modes = [1, '0-2']"), Contains("1 is listed twice"));
  CHECK_THAT(error_in("difficulties = [4]"), Contains("difficulties: must be numbers from 0 to 3"));
  CHECK_THAT(error_in("default_mode = 3"), Contains("default_mode: 3 is not one of the modes"));
  CHECK_THAT(error_in("paddle_max = 0"), Contains("paddle_max: 0 is not a resistance in ohms, at least 1"));
  CHECK_THAT(error_in("[[image]]\nleft = 'mouse'"), Contains("image.left: unknown value 'mouse'"));
  CHECK_THAT(error_in("[[image]]\nformat = 'pal'"), Contains("NTSC"));
  for (const char* ystart : {"-1", "51"})
    CHECK_THAT(error_in("[[image]]\nystart = " + std::string(ystart)),
               Contains("image.ystart: " + std::string(ystart) + " is out of range; accepted: 0 to 50"));
  for (const char* height : {"99", "257"})
    CHECK_THAT(error_in("[[image]]\nheight = " + std::string(height)),
               Contains("image.height: " + std::string(height) + " is out of range; accepted: 100 to 256"));
  CHECK_THAT(error_in("[[image]]\nystart = 50\nheight = 251"),
             Contains("the sum of ystart and height is 301; it must be at most 300"));
  const std::string digits = "0123456789abcdef0123456789abcde";
  for (const char* end : {"", "F", "g", "00"})
    CHECK_THAT(error_in("[[image]]\nmd5 = '" + digits + end + "'"), Contains("image.md5: must be 32"));
  CHECK_THAT(error_in("[image]\nleft = 'paddles'"), Contains("image: must be a list"));
}

TEST_CASE("facts at their limits are accepted") {
  const Game game = game_with(
      "start = ['FIRE 60000', 'NOOP 40000']\nmodes = [0, 65535]\npaddle_max = 1\n"
      "[[image]]\nystart = 0\nheight = 256\n");
  CHECK(game.starting_actions.size() == 100000);
  CHECK(game.modes == std::vector<int>{0, 65535});
  CHECK(game.paddle_max == 1);
  CHECK(game.properties_for("any").ystart == 0);
  CHECK(game.properties_for("any").height == 256);
  CHECK(game_with("start = ['FIRE 100000']").starting_actions.size() == 100000);
  for (const auto& [ystart, height] : {std::pair(50, 250), std::pair(50, 100)}) {
    const Game other =
        game_with("[[image]]\nystart = " + std::to_string(ystart) + "\nheight = " + std::to_string(height));
    CHECK(other.properties_for("any").ystart == ystart);
    CHECK(other.properties_for("any").height == height);
  }
}

TEST_CASE("a game file that cannot be read is refused") {
  const Scratch scratch;
  CHECK_THROWS_WITH(load_game_file(scratch.path("none.toml")),
                    Contains("none.toml") && Contains("no such file"));
  CHECK_THROWS_WITH(load_game_file(scratch.path("")), Contains("directory"));
  CHECK_THROWS_WITH(load_game_file(scratch.write("big.toml", std::string(2 << 20, '#'))),
                    Contains("larger than 1048576 bytes"));
  const std::string broken = scratch.write("broken.toml", "title = 'T'\nmodes = 3\n");
  CHECK_THROWS_WITH(load_game_file(broken), Contains(broken + ":2: modes:"));
  CHECK(load_game_file(scratch.write("fine.toml", "title = 'T'\n"))->name == "fine");
}

// toml++ 3.3 has undefined behaviour here. If that occurred, a build with sanitizers would fail.
TEST_CASE("letters beyond ASCII are part of texts and comments, and nothing else") {
  const Game game = parse_game("title = 'Gr\xC3\xB6\xC3\x9F' # gr\xC3\xBC\xC3\x9F\n", "test", "my.toml");
  CHECK(game.title == "Gr\xC3\xB6\xC3\x9F");
  for (const std::string letter : {"\xC2\xA7", "\xC3\xA4", "\xE2\x80\x93", "\xEF\xBB\xBB"}) {
    CHECK_THAT(error_in(letter + " = 1"), Catch::StartsWith("my.toml:2: TOML: "));
    CHECK_THAT(error_in("modes = " + letter), Catch::StartsWith("my.toml:2: TOML: "));
    CHECK_THAT(error_in("modes = b\"" + letter + "\""), Catch::StartsWith("my.toml:2: TOML: "));
  }
}

TEST_CASE("[fixed] replaces keys of [rule] and keeps the others") {
  const Game game = game_with("minimal = ['FIRE']\n[rule]\nsource = 'racebeam'\nlives = '7'\n" + kStep +
                              "[fixed]\nwraps = 256\nminimal = ['NOOP', 'FIRE']\nreference = 'r'\n"
                              "correction = 'c'\nevidence = 'e'\n");
  REQUIRE(game.fixed);
  CHECK(game.rule_source == RuleSource::kRacebeam);
  CHECK(game.correction.wraps == 256);
  CHECK(game.correction.correction == "c");
  CHECK(game.minimal_actions == std::vector<int>{1});
  CHECK(game.fixed->minimal_actions == std::vector<int>{0, 1});
  CHECK(Rule(*game.fixed).lives() == 7);
  FakeMemory memory;
  Rule before(game), after(*game.fixed);
  for (const int score : {255, 1}) {
    memory[0x80] = static_cast<std::uint8_t>(score);
    before.step(memory.memory());
    after.step(memory.memory());
  }
  CHECK(before.reward() == -254);
  CHECK(after.reward() == 2);
  CHECK_FALSE(game_with("[rule]\n" + kStep).fixed);
}

TEST_CASE(
    "[classic] replaces keys of [rule], starting actions and modes, and leaves corrections to [fixed]") {
  const Game game = game_with("modes = [5, 2]\nstart = ['FIRE']\n[rule]\nlives = '7'\n" + kStep +
                              "[fixed]\nlives = '9'\nreference = 'r'\ncorrection = 'c'\nevidence = 'e'\n"
                              "[classic]\nsingle_mode = true\nstart = ['NOOP 2']\nlives = '8'\n"
                              "[mode]\nsetup = 'soft_reset'\n");
  REQUIRE(game.classic);
  REQUIRE(game.classic->fixed);
  CHECK(Rule(game).lives() == 7);
  CHECK(Rule(*game.classic).lives() == 8);
  CHECK(Rule(*game.classic->fixed).lives() == 9);
  for (const Game* const old : {game.classic.get(), game.classic->fixed.get()}) {
    CHECK(old->modes == std::vector<int>{5});
    CHECK(old->mode_program.statements.empty());
    CHECK(old->starting_actions == std::vector<int>{0, 0});
  }
  CHECK(game.modes == std::vector<int>{5, 2});
  CHECK(game.mode_program.statements.size() == 1);
  CHECK(game.starting_actions == std::vector<int>{1});
  CHECK_FALSE(game_with("[rule]\n" + kStep).classic);
}

TEST_CASE("modes for two players are offered beside the others") {
  const Game game = game_with("modes = [5, 2]\ntwo_player_modes = [1, '5-6']\n");
  CHECK(game.modes == std::vector<int>{5, 2});
  CHECK(game.two_player_modes == std::vector<int>{1, 5, 6});
  CHECK(game.offered_modes() == std::vector<int>{1, 2, 5, 6});
}

TEST_CASE("mistakes in corrections, sources and wraps are named with their line") {
  const std::string rule = "[rule]\n" + kStep;  // lines 2 to 6
  CHECK_THAT(
      error_in(rule + "[fixed]\nlives = '1'\n"),
      Equals("my.toml:7: fixed.reference: a correction that has more than 'wraps' must have this key"));
  CHECK_THAT(
      error_in(rule + "[fixed]\nwraps = 10\nlives = '1'\n"),
      Equals("my.toml:7: fixed.reference: a correction that has more than 'wraps' must have this key"));
  CHECK(error_in(rule + "[fixed]\nwraps = 10\n").empty());
  CHECK_THAT(error_in(rule + "[fixed]\nwraps = 9\n"),
             Contains("my.toml:8: fixed.wraps: must be at least 10"));
  CHECK_THAT(error_in(rule + "[fixed]\nmodes = [1]\n"), Contains("my.toml:8: fixed.modes: unknown key"));
  CHECK_THAT(error_in(rule + "[fixed]\nstep = \"score = x\\nterminal = 0\"\n"),
             Contains("my.toml:8: fixed.step: nothing assigns 'x'"));
  CHECK_THAT(error_in("[fixed]\nwraps = 100\n"),
             Contains("my.toml:2: fixed: a correction requires a [rule]"));
  CHECK_THAT(error_in(rule + "[classic]\nmodes = [1]\n"), Contains("my.toml:8: classic.modes: unknown key"));
  CHECK_THAT(error_in("[classic]\nsingle_mode = true\n"),
             Contains("my.toml:2: classic: a classic rule requires a [rule]"));
  CHECK_THAT(error_in("[rule]\nsource = 'xitari'\n" + kStep),
             Contains("my.toml:3: rule.source: unknown value 'xitari'; accepted: ale-0.12 and racebeam"));
  CHECK_THAT(error_in("[rule]\nstep = 'reward = wrap(1, ram[0x80])'\n"),
             Contains("my.toml:3: rule.step: wrap() takes a constant of at least 10"));
}

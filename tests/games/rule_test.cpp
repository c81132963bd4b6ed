#include <catch2/catch.hpp>

#include <cstring>
#include <type_traits>

#include "games/catalogue.hpp"
#include "tests/games/game_text.hpp"

using namespace racebeam;

static_assert(std::is_trivially_copyable_v<RuleState>);

TEST_CASE("a rule counts the change of the score, unless it says what the reward is") {
  const Game game = game_with_step("score = ram[0x80]\nterminal = ram[0x81] == 1");
  FakeMemory memory;
  Rule rule(game);
  memory[0x80] = 5;
  rule.step(memory.memory());
  CHECK(rule.reward() == 5);
  memory[0x80] = 3;
  rule.step(memory.memory());
  CHECK(rule.reward() == -2);
  CHECK_FALSE(rule.terminal());
  memory[0x81] = 1;
  rule.step(memory.memory());
  CHECK(rule.reward() == 0);
  CHECK(rule.terminal());
}

TEST_CASE("a name means its new value once the step has assigned it, and prev its old one") {
  const Game game =
      game_with_step("before = x\nx = ram[0x80]\nreward = 100 * before + 10 * prev(x) + x\nterminal = 0");
  FakeMemory memory;
  Rule rule(game);
  memory[0x80] = 1;
  rule.step(memory.memory());
  CHECK(rule.reward() == 1);
  memory[0x80] = 2;
  rule.step(memory.memory());
  CHECK(rule.reward() == 112);
}

TEST_CASE("variables that wait for each other exchange their old values") {
  const Game game = game_with_step("keep_a = a\na = b\nb = keep_a\nreward = 10 * a + b\nterminal = 0",
                                   "reset = { a = 1, b = 2 }");
  Rule rule(game);
  rule.step(FakeMemory{}.memory());
  CHECK(rule.reward() == 21);
  rule.step(FakeMemory{}.memory());
  CHECK(rule.reward() == 12);
}

TEST_CASE("a reset gives variables their first values and leaves those alone that are kept") {
  const Game game = game_with_step("n = n + 1\nm = m + 1\nreward = 100 * m + n\nterminal = 0",
                                   "reset = { n = 7 }\nkeep = ['m']");
  Rule rule(game);
  rule.step(FakeMemory{}.memory());
  CHECK(rule.reward() == 108);
  rule.reset();
  CHECK(rule.reward() == 0);
  rule.step(FakeMemory{}.memory());
  CHECK(rule.reward() == 208);
  CHECK(rule.keeps_variables());
  CHECK_FALSE(
      Rule(game_with_step("n = n + 1\nreward = n\nterminal = 0", "reset = { n = 7 }")).keeps_variables());
  CHECK_FALSE(Rule(Game{}).keeps_variables());
}

TEST_CASE("lives at the beginning do not count what is kept from earlier episodes") {
  const Game game =
      game_with_step("m = m + 2\nlives = m + 1\nreward = 0\nterminal = 0", "keep = ['m']\nlives = 'm + 3'");
  Rule rule(game);
  rule.step(FakeMemory{}.memory());
  CHECK(rule.lives() == 5);
  CHECK(rule.initial_lives() == 3);
  CHECK(rule.lives() == 5);
}

TEST_CASE("a step that would change nothing is left out, and no other one is") {
  const Game game =
      game_with_step("score = ram[0x80]\nn = n + ram[0x81]\nlives = n\nterminal = ram[0x82]", "lives = 'n'");
  FakeMemory memory;
  Rule rule(game);
  const RuleState first = rule.state();
  memory[0x80] = 4;
  for (const int reward : {4, 0, 0}) {
    rule.step(memory.memory());
    CHECK(rule.reward() == reward);
  }
  memory[0x90] = 1;  // not read
  rule.step(memory.memory());
  CHECK(rule.reward() == 0);
  rule.restore(first);  // with the same bytes, but another score before
  rule.step(memory.memory());
  CHECK(rule.reward() == 4);
  rule.step(memory.memory());
  rule.step(memory.memory());
  rule.reset();
  rule.step(memory.memory());
  CHECK(rule.reward() == 4);
  memory[0x81] = 1;  // changes a variable in each frame
  for (const int lives : {1, 2, 3}) {
    rule.step(memory.memory());
    CHECK(rule.lives() == lives);
  }
  memory[0x82] = 1;
  rule.step(memory.memory());
  CHECK(rule.terminal());
}

TEST_CASE("a byte that a rule reads through another one, or on the bus, is never taken for the same") {
  const Game through = game_with_step("x = ram[ram[0x80]]\nreward = x\nterminal = 0");
  FakeMemory memory;
  Rule rule(through);
  memory[0x80] = 0x85;
  for (int frame = 0; frame < 3; ++frame) rule.step(memory.memory());
  memory[0x85] = 7;
  rule.step(memory.memory());
  CHECK(rule.reward() == 7);
  CHECK(through.rule->inputs);
  CHECK_FALSE(game_with_step("reward = mem[0x1000 + ram[0x80]]\nterminal = 0").rule->inputs);
}

// What a rule reads last stays on the bus.
TEST_CASE("the byte that a rule reads last is known unless an address depends on values") {
  const auto last = [](const std::string& reward) {
    const Game game = game_with_step("a = ram[0x90]\nreward = " + reward + "\nterminal = 0");
    return Rule(game).last_byte();
  };
  CHECK(last("ram[0x80] + ram[0x85]") == 5);
  CHECK(last("ram[0x85] + ram[0x80]") == 0);
  CHECK(last("mem[0x1000] + ram[0xFF] + 1") == 127);
  CHECK(last("ram[0x80 + a] + ram[0x86]") == 6);
  CHECK(last("ram[0x86] + ram[0x80 + a]") == std::nullopt);
  CHECK(last("ram[0x86] + mem[0x1000]") == std::nullopt);
  const Game reads_none = game_with_step("reward = 1\nterminal = 0");
  CHECK(Rule(reads_none).last_byte() == std::nullopt);
  CHECK(Rule(Game{}).last_byte() == std::nullopt);
}

TEST_CASE("lives are the variable of that name while the game runs, or else 1") {
  FakeMemory memory;
  const Game with =
      game_with_step("reward = 0\nlives = ram[0x80]\nterminal = ram[0x81]", "reset = { lives = 4 }");
  Rule rule(with);
  CHECK(rule.lives() == 4);
  CHECK(rule.initial_lives() == 4);
  memory[0x80] = 3;
  rule.step(memory.memory());
  CHECK(rule.lives() == 3);
  CHECK(rule.initial_lives() == 4);
  memory[0x81] = 1;
  rule.step(memory.memory());
  CHECK(rule.lives() == 0);

  const Game without = game_with_step("reward = 0\nterminal = ram[0x81]");
  Rule other(without);
  CHECK(other.lives() == 1);
  other.step(memory.memory());
  CHECK(other.lives() == 0);
}

TEST_CASE("a rule can answer lives and the end in its own way") {
  const Game game = game_with_step("reward = 0\nstarted = prev(started) || ram[0x80]\nterminal = 1",
                                   "terminal = 'started && terminal'\nlives = '5 - started'");
  Rule rule(game);
  FakeMemory memory;
  rule.step(memory.memory());
  CHECK_FALSE(rule.terminal());
  CHECK(rule.lives() == 5);
  memory[0x80] = 1;
  rule.step(memory.memory());
  CHECK(rule.terminal());
  CHECK(rule.lives() == 4);
}

TEST_CASE("the state of a rule is all that it remembers, and no more") {
  const Game game = game_with_step("digit = ram[0x80] & 15\nscore = 10 * digit\nterminal = 0");
  CHECK(game.rule->variables.size() == 3);  // reward, terminal, score: digit lives within a step only
  FakeMemory memory;
  Rule rule(game), other(game);
  memory[0x80] = 3;
  rule.step(memory.memory());
  other.restore(rule.state());
  CHECK(std::memcmp(&rule.state(), &other.state(), sizeof(RuleState)) == 0);
  memory[0x80] = 5;
  rule.step(memory.memory());
  other.step(memory.memory());
  CHECK(other.reward() == 20);
  CHECK(rule.state() == other.state());
}

TEST_CASE("addresses and other constants are gone from a compiled rule") {
  const Game game = game_with_step("reward = ram[0x80 + 2 * 3]\nterminal = 0");
  CHECK(game.rule->step.code.size() == 2);  // the load and the 0
}

TEST_CASE("a game without a rule gives neither rewards nor an end") {
  const Game game = game_without_rule("unknown");
  Rule rule(game);
  rule.reset();
  rule.step(FakeMemory{}.memory());
  CHECK(rule.reward() == 0);
  CHECK_FALSE(rule.terminal());
  CHECK(rule.lives() == 0);
  CHECK(rule.initial_lives() == 0);
}

TEST_CASE("Seaquest's rule reads score, lives and the end from their places") {
  const auto game = find_game("seaquest");
  FakeMemory memory;
  Rule rule(*game);
  memory[0xBA] = 0x20;
  memory[0xB9] = 0x01;
  memory[0xBB] = 2;
  rule.step(memory.memory());
  CHECK(rule.reward() == 120);
  CHECK(rule.lives() == 3);
  CHECK(rule.initial_lives() == 4);
  memory[0xA3] = 1;
  rule.step(memory.memory());
  CHECK(rule.terminal());
  CHECK(rule.lives() == 0);
}

TEST_CASE("wrap() turns a fall by most of the modulus into a gain, and nothing else") {
  const Game game = game_with_step("reward = wrap(ram[0x80] * 100 - 10000, 1000)\nterminal = 0");
  FakeMemory memory;
  Rule rule(game);
  const auto reward = [&](int hundreds) {
    memory[0x80] = static_cast<std::uint8_t>(hundreds);
    rule.step(memory.memory());
    return rule.reward();
  };
  CHECK(reward(90) == 0);     // -1000
  CHECK(reward(91) == 100);   // -900
  CHECK(reward(92) == -800);  // a score that was cleared
  CHECK(reward(108) == 800);
  CHECK(reward(109) == -100);  // a loss below 0
}

TEST_CASE("a score that wraps is told by a number, for both players") {
  const Game game = game_with_step("score = bcd(0x80)\nscore_b = bcd(0x81)\nterminal = 0", "wraps = 100");
  FakeMemory memory;
  Rule rule(game);
  memory[0x80] = memory[0x81] = 0x98;
  rule.step(memory.memory());
  memory[0x80] = 0x01;
  memory[0x81] = 0x00;
  rule.step(memory.memory());
  CHECK(rule.reward() == 3);
  CHECK(rule.reward_b() == 2);
}

TEST_CASE("player B's reward is the change of score_b or what the rule says, and 0 if it says nothing") {
  FakeMemory memory;
  memory[0x80] = 7;
  const Game zero_sum = game_with_step("score = ram[0x80]\nscore_b = -score\nterminal = 0");
  const Game own = game_with_step("reward = ram[0x80]\nreward_b = 2 * reward\nterminal = 0");
  const Game none = game_with_step("reward = ram[0x80]\nterminal = 0");
  const auto reward_b = [&](const Game& game) {
    Rule rule(game);
    rule.step(memory.memory());
    const RuleState copy = rule.state();
    Rule other(game);
    other.restore(copy);
    CHECK(other.reward_b() == rule.reward_b());
    return rule.reward_b();
  };
  CHECK(reward_b(zero_sum) == -7);
  CHECK(reward_b(own) == 14);
  CHECK(reward_b(none) == 0);
  CHECK(zero_sum.has_second_reward());
  CHECK_FALSE(none.has_second_reward());
}

TEST_CASE("A rule names the bytes of RAM that it reads, each by the first variable that it goes into") {
  const Game game = game_with_step(
      "digits = bcd(0x90, 0x8F)\nlives = ram[0x81] & 7\nscore = 10 * digits + ram[0x81]\n"
      "all = sum(i, 0, 1, ram[0xA0 + i]) + ram[ram[0xB0]]\nterminal = lives == 0 || mem[0x1234]");
  std::string named;
  for (const auto& [index, name] : game.rule->bytes) named += std::to_string(index) + ":" + name + " ";
  CHECK(named == "1:lives 15:digits 16:digits 32:all 33:all 48:all ");
}

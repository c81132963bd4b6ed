#include <catch2/catch.hpp>

#include <cstring>
#include <type_traits>

#include "games/catalogue.hpp"
#include "tests/games/game_text.hpp"

using namespace racebeam;
using Catch::Contains;

static_assert(std::is_trivially_copyable_v<Tally>);

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

TEST_CASE("a tally holds all that a rule remembers, and no more than that") {
  const Game game = game_with_step("digit = ram[0x80] & 15\nscore = 10 * digit\nterminal = 0");
  CHECK(game.rule->variables.size() == 3);  // reward, terminal, score: digit lives within a step only
  FakeMemory memory;
  Rule rule(game), other(game);
  memory[0x80] = 3;
  rule.step(memory.memory());
  other.restore(rule.tally());
  CHECK(std::memcmp(&rule.tally(), &other.tally(), sizeof(Tally)) == 0);
  memory[0x80] = 5;
  rule.step(memory.memory());
  other.step(memory.memory());
  CHECK(other.reward() == 20);
  CHECK(rule.tally() == other.tally());
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

// A game's running tally: reward, end and lives, brought up to date after every frame.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "games/game/memory.hpp"
#include "games/game/program.hpp"

namespace racebeam {

struct Game;

constexpr int kRewardSlot = 0, kTerminalSlot = 1;  // the variables that every rule has

// All that a rule remembers from frame to frame. One trivially copyable value, so that saving it is a copy.
struct Tally {
  std::array<std::int32_t, kMaxVariables> values{};
  bool operator==(const Tally&) const = default;
};

// One thing that a rule remembers.
struct Variable {
  std::string name;
  std::int32_t initial = 0;  // after a reset
  bool kept = false;         // a reset leaves it alone; 0 before it is first assigned
};

// The rule of a game file, compiled.
struct RuleProgram {
  std::vector<Variable> variables;  // variable n is Tally::values[n]
  Program step;
  Program terminal, lives;  // what is answered; they look at variables only
  std::optional<int> reward_b;  // the variable that is player B's reward, if the rule knows one
};

class Rule {
 public:
  explicit Rule(const Game& game);  // the game must outlive its rule

  void reset();                     // a new episode
  void step(const Memory& memory);  // after a frame

  // A game without a rule answers 0, false and 0.
  int reward() const;    // player A's, of the last frame
  int reward_b() const;  // player B's; 0 if the rule has no second player
  bool terminal() const;
  int lives() const;
  int initial_lives() const;  // what lives() answers right after a reset: what "loss of life" compares with

  bool keeps_variables() const;  // what they hold outlives a reset

  const Tally& tally() const { return tally_; }
  void restore(const Tally& tally) { tally_ = tally; }

 private:
  const RuleProgram* program_;  // null: the game has no rule
  Tally tally_;
};

}  // namespace racebeam

// The state of a game's rule: reward, end and lives, updated after every frame.
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

// The state that a rule keeps from frame to frame. Trivially copyable, so that saving it is a copy.
struct RuleState {
  std::array<std::int32_t, kMaxVariables> values{};
  bool operator==(const RuleState&) const = default;
};

// A variable that a rule keeps.
struct Variable {
  std::string name;
  std::int32_t initial = 0;  // after a reset
  bool kept = false;         // it persists over resets; 0 before its first assignment
};

// A byte of RAM that a rule reads, and the variable that it goes into.
struct NamedByte {
  int index;  // 0-127
  std::string name;
};

// The rule of a game file, compiled.
struct RuleProgram {
  std::vector<Variable> variables;  // variable n is RuleState::values[n]
  Program step;
  std::optional<RamMask> inputs;  // all memory that `step` reads, if that is RAM only
  Program terminal, lives;        // for queries; they read variables only
  std::optional<int> reward_b;    // the variable with player B's reward, if the rule has one
  std::vector<NamedByte> bytes;  // in the order of their indices; where several variables read one, the first
};

class Rule {
 public:
  explicit Rule(const Game& game);  // the game must outlive its rule

  void reset();                     // a new episode
  void step(const Memory& memory);  // after a frame

  // A game without a rule returns 0, false and 0.
  int reward() const;    // player A's, of the last frame
  int reward_b() const;  // player B's; 0 if the rule has no second player
  bool terminal() const;
  int lives() const;
  int initial_lives() const;  // lives() right after a reset; "loss of life" is relative to it

  // The byte of RAM that step() reads last, 0-127. Nothing if it reads none, or if that depends on its
  // values.
  std::optional<int> last_byte() const;

  bool keeps_variables() const;  // whether a variable persists over resets

  const RuleState& state() const { return state_; }
  void restore(const RuleState& state) {
    state_ = state;
    is_settled_ = false;
  }

 private:
  bool would_change_nothing(const std::uint8_t* ram) const;

  const RuleProgram* program_;  // null: the game has no rule
  RuleState state_;
  // The last step() changed no variable, and read these bytes. With the same bytes, the next one changes
  // none.
  bool is_settled_ = false;
  std::array<std::uint8_t, kRamBytes> settled_ram_{};
};

}  // namespace racebeam

// How a game variation is put in place during a reset: SELECT presses, waits and checks
// (docs/spec/games/README.md, 3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "games/game/program.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

struct Game;

// The machine and its environment, as a mode program sees them.
struct ModeHost {
  virtual ~ModeHost() = default;
  virtual Memory memory() = 0;
  virtual void select(int frames) = 0;          // hold SELECT so long, then one frame with nothing pressed
  virtual void act(int action, int count) = 0;  // so many environment actions of player A
  virtual void soft_reset() = 0;                // press RESET
  virtual std::uint32_t random() = 0;           // one draw of the environment's generator
};

struct Statement {
  enum class Kind : std::uint8_t { kAssign, kSelect, kAct, kSoftReset, kWhile, kIf, kFail };
  Kind kind = Kind::kSoftReset;
  Program expression{};                // the value, number of frames, count or condition
  bool draws = false;                  // the expression uses rng()
  int target = 0;                      // kAssign: variable; kAct: action
  std::vector<Statement> body{};       // kWhile, kIf
  std::vector<Statement> otherwise{};  // kIf
  std::string text{};                  // kFail
};

// A mode program's own variables come after those of the rule.
constexpr int kModeSlot = kMaxVariables, kRandomSlot = kMaxVariables + 1, kFirstLocalSlot = kMaxVariables + 2;
constexpr int kMaxModeVariables = 2 * kMaxVariables;

struct ModeProgram {
  std::vector<Statement> statements;
};

// Of all loops of one run. The games of the catalogue take 683 at most (video_cube), so that more means that the image is not
// the one the program was written for.
constexpr int kModeTurns = 1000;

// Puts `mode` in place. Throws InvalidInput when that can't be done with the image that is running.
void run_mode_program(const Game& game, Rule& rule, int mode, ModeHost& host);

}  // namespace racebeam

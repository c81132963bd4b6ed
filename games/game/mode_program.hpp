// Selects a game variation during a reset: SELECT presses, waits and checks (docs/spec/games/README.md, 3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "games/game/program.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

struct Game;

// The machine and its environment, as a mode program uses them.
struct ModeHost {
  virtual ~ModeHost() = default;
  virtual Memory memory() = 0;
  virtual void select(int frames) = 0;          // holds SELECT for `frames`, then nothing for one frame
  virtual void act(int action, int count) = 0;  // repeats an action of player A
  virtual void soft_reset() = 0;                // presses RESET
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

// The most iterations of all loops in one run. The games of the catalogue take 683 at most (video_cube). A
// program that takes more was not written for the image.
constexpr int kModeTurns = 1000;

// The most frames of `select`, and acts, of one run. The games of the catalogue take 871 at most
// (video_cube).
constexpr int kModeFrames = 20'000;

// Selects `mode`. Throws InvalidInput if the running image does not reach it.
void run_mode_program(const Game& game, Rule& rule, int mode, ModeHost& host);

}  // namespace racebeam

// What a program costs on the interpreter and on the translator, from power-on, in processor time.
#pragma once

#include <vector>

#include "emulator/console.hpp"
#include "tests/translator/program.hpp"

namespace racebeam::test {

struct Cost {
  double interpreted = 0, translated = 0;  // microseconds
  double ratio() const { return translated / interpreted; }
};

enum class Look { kNone, kEveryFrame };  // at the picture

// Switches a machine on, runs it for so many steps, and throws it away, on both in turns: the medians of
// `rounds` rounds. What translation needs is begun afresh in each.
Cost cost_of(const Program& program, int steps, Look look, int rounds);

// The longest step of such a run, and of each the shortest time that it took in `rounds` rounds.
Cost longest_step(const Program& program, int steps, Look look, int rounds);

}  // namespace racebeam::test

// The cost of a program on the interpreter and on the translator, from power-on, in processor time.
#pragma once

#include <vector>

#include "emulator/console.hpp"
#include "tests/translator/random_program.hpp"

namespace racebeam::test {

struct Cost {
  double interpreted = 0, translated = 0;  // microseconds
  double ratio() const { return translated / interpreted; }
};

enum class Look { kNone, kEveryFrame };  // whether the picture is read

// Switches a machine on, runs `steps` steps, and releases it, alternately with both CPUs. Returns the medians
// of `rounds` rounds. Each round translates from the beginning.
Cost cost_of(const Program& program, int steps, Look look, int rounds);

// Does this once with one CPU.
void play(const Program& program, int steps, Look look, CpuKind cpu);

// The longest step of such a run. For each step, the shortest time of `rounds` rounds counts.
Cost longest_step(const Program& program, int steps, Look look, int rounds);

}  // namespace racebeam::test

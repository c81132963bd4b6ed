// racebeam bench --commands: a measurement in parts that another program controls. Between them, that program
// can let the reference play the same acts (scripts/measure/bench_core.py).
#pragma once

#include <iosfwd>

#include "cli/arguments/options.hpp"

namespace racebeam {

// Answers each line of `commands` with a line of JSON, until the input ends:
//
//   play A A ...    plays these actions, one act each, timed; a game that is over is reset
//   check A A ...   the same, not timed, with a checksum of the results of all acts
//   reset N         times N resets
//   save N          times N saves, each followed by a restore
//
// look: the screen is observed after each act, and part of the checksums; else only RAM and rewards are.
// Throws std::invalid_argument for any other line.
void run_bench_session(const Cartridge& cartridge, const MachineOptions& options, bool look,
                       std::istream& commands, std::ostream& answers);

}  // namespace racebeam

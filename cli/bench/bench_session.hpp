// racebeam bench --commands: a measurement that another program conducts, chunk by chunk, so that it can let
// the reference play the same acts in between (scripts/measure/bench_core.py).
#pragma once

#include <iosfwd>

#include "cli/arguments/options.hpp"

namespace racebeam {

// Answers each line of `commands` with one of JSON, and ends with the input:
//
//   play A A ...    plays these actions, one act each, timed; a game that is over is reset
//   check A A ...   the same, not timed, with a checksum of all that the acts led to
//   reset N         times N resets
//   save N          times N snapshots, each taken and restored at once
//
// `look`: the screen is looked at after each act, and is in the checksums; else RAM and rewards alone.
// Throws std::invalid_argument for a line that is none of these.
void run_bench_session(const Cartridge& cartridge, const MachineOptions& options, bool look,
                       std::istream& commands, std::ostream& answers);

}  // namespace racebeam

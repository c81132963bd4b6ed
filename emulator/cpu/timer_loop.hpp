// Most games end a frame with a loop that reads the timer until it has run out: LDA INTIM, BNE to it. The
// number of iterations until the branch falls through is a division. All but the last are skipped in one
// step.
#pragma once

#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

constexpr std::int8_t kTimerLoopOffset = -5;  // of a branch back to the three-byte instruction before it

// How many iterations, of `period` cycles each, will certainly branch again if the next read is at
// `next_read`. The loop's two instructions are at branch[-3] and branch[0], and the branch has been taken.
// Returns 0 if this is not a timer loop.
std::int32_t sure_timer_turns(const std::uint8_t* branch, const RiotState& riot, std::int32_t next_read,
                              std::int32_t period);

// Whether the branch closes a timer loop.
bool is_timer_loop(const std::uint8_t* branch);

}  // namespace racebeam

// Most games end a frame by reading the timer until it has run out: LDA INTIM, BNE to it. The number of turns until
// the branch falls through is a division, so that all but the last are skipped in one step.
#pragma once

#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

constexpr std::int8_t kTimerLoopOffset = -5;  // of a branch back to the three-byte instruction before it

// The loop's two instructions are at branch[-3] and branch[0]; the branch has been taken. How many turns, of `period`
// cycles each, will certainly branch again when the next read comes at `next_read`? 0 if this is no timer loop.
std::int32_t sure_timer_turns(const std::uint8_t* branch, const RiotState& riot, std::int32_t next_read,
                              std::int32_t period);

// Is it one?
bool is_timer_loop(const std::uint8_t* branch);

}  // namespace racebeam

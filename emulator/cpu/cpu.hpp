// The 6507: an instruction-granular interpreter (docs/spec/cpu.md).
#pragma once

#include "emulator/board/board.hpp"

namespace racebeam {

// The reset line: registers cleared, PC from the vector at $FFFC. Takes no cycles.
void reset_cpu(Board& board);

// Runs up to `instructions` instructions, at most 4,000,000; ends early, between two of them, when the board asks to stop
// or the chip jams.
void interpret(Board& board, std::int32_t instructions);

// The same, but it also ends at a jump or a branch after `enough` instructions. Much faster where `enough` is smaller than
// `most` by Core::kLongestRow, since instructions need not be counted one by one.
void interpret(Board& board, std::int32_t most, std::int32_t enough);

}  // namespace racebeam

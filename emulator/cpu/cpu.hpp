// The 6507: an interpreter that executes whole instructions (docs/spec/cpu.md).
#pragma once

#include "emulator/board/board.hpp"

namespace racebeam {

// The reset line: clears the registers, and loads PC from the vector at $FFFC. Takes no cycles.
void reset_cpu(Board& board);

// Runs up to `instructions` instructions, at most 4,000,000. Ends early, between two of them, if the board
// asks to stop or the CPU jams.
void interpret(Board& board, std::int32_t instructions);

// This one also ends at a jump or a branch after `enough` instructions. If `enough` is below `most`
// by Core::kLongestRow or more, this is much faster, because instructions need not be counted one by one.
// stays: it also ends where the code leaves the memory in which it began.
void interpret(Board& board, std::int32_t most, std::int32_t enough, bool stays = false);

// The first one, for a cartridge that sees all accesses to operands (MapperOps::observe).
void interpret_observed(Board& board, std::int32_t instructions);

}  // namespace racebeam

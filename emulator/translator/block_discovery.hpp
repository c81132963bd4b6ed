// Finds the code that can be reached from an entry within one window of ROM, and cuts it into blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/cartridge/memory_map.hpp"
#include "emulator/translator/instruction.hpp"

namespace racebeam::translator {

// A basic block: it is entered at its first instruction only. A taken branch leaves it. After the last
// instruction, unless that jumps, execution continues at `next`.
struct Block {
  std::uint16_t pc = 0;
  std::uint16_t next = 0;
  std::vector<Instruction> instructions;
  bool is_loop_head = false;  // the target of a backward jump
};

// Whether all bytes of an instruction at `pc` can be read in the window.
inline bool contains(const CodeWindow& window, std::uint16_t pc) {
  return static_cast<std::uint16_t>(pc - window.first) < window.span;
}

// Returns the blocks in the order of their addresses. known: by offset in the window, where blocks exist
// already.
std::vector<Block> discover(const CodeWindow& window, std::uint16_t entry, const std::vector<bool>& known);

}  // namespace racebeam::translator

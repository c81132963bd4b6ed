// Finds the code that can be reached from an entry within one window of ROM, and cuts it into blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/cartridge/memory_map.hpp"
#include "emulator/translator/instruction.hpp"

namespace racebeam::translator {

// A basic block: it is entered only at its first instruction. A taken branch leaves it. Unless the last
// instruction jumps, execution continues at `next` after it.
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

// Returns the blocks in the order of their addresses. known: for each offset in the window, whether a block
// exists there already.
std::vector<Block> discover(const CodeWindow& window, std::uint16_t entry, const std::vector<bool>& known);

}  // namespace racebeam::translator

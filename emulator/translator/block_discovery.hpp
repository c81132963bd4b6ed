// What can be reached soon from an entry without leaving a run of plain ROM, cut into blocks.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/cartridge/memory_map.hpp"
#include "emulator/translator/instruction.hpp"

namespace racebeam::translator {

// Code that is entered at its first instruction only. Branches leave it when they are taken; after the last
// instruction, unless that jumps, it goes on at `next`.
struct Block {
  std::uint16_t pc = 0;
  std::uint16_t next = 0;
  std::vector<Instruction> instructions;
  bool loops = false;  // something jumps backwards to it
};

constexpr int kMostBlockCycles = 300;  // of a block, WSYNC apart

// An instruction of the window: the whole of it can be read there.
inline bool holds(const CodeWindow& window, std::uint16_t pc) {
  return static_cast<std::uint16_t>(pc - window.first) < window.span;
}

// The blocks in the order of their addresses. known: by offset in the window, where blocks exist already.
std::vector<Block> discover(const CodeWindow& window, std::uint16_t entry, const std::vector<bool>& known);

}  // namespace racebeam::translator

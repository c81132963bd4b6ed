// The x86-64 assembler for one batch of blocks, and what the blocks of a batch share: places in a Board, labels, ways out.
#pragma once

#include <xbyak/xbyak.h>

#include <cstdint>
#include <unordered_map>

#include "emulator/translator/window.hpp"

namespace racebeam {
class Board;
}

namespace racebeam::translator {

// Bytes from a Board to what translated code uses of it: the same for all Boards.
struct Layout {
  explicit Layout(Board& board);

  std::int32_t ram, a, x, y, sp, cycle, pages, stop, code_span, last_access, slot, sound;
  std::int32_t limit, first_line, waited, nz, carry, overflow, decimal, interrupt;
};

class Assembler : public Xbyak::CodeGenerator {
 public:
  // Writes to `memory`. out: where code goes that leaves translation, with what kInterpretNext says in eax.
  Assembler(void* memory, std::size_t size, const Layout& places, const Window& seen, const void* out)
      : CodeGenerator(size, memory), layout(places), window(seen), way_out(out) {}

  const Layout& layout;
  const Window& window;
  const void* way_out;
  std::unordered_map<std::uint16_t, Xbyak::Label> blocks;  // of this batch, by address

  // The byte of the window at an address, if it has it.
  bool covers(std::uint16_t address) const { return offset_of(address) < size(); }
  bool covers(std::uint16_t first, unsigned count) const { return offset_of(first) + count <= size(); }
  std::uint8_t byte_at(std::uint16_t address) const { return window.code.memory[offset_of(address)]; }
  unsigned offset_of(std::uint16_t address) const {
    // Pages repeat with bits 15 and 14, which are not decoded.
    return static_cast<std::uint16_t>((address & 0x3FFF) - (window.code.first & 0x3FFF));
  }
  unsigned size() const { return window.code.span + 2U; }

  using CodeGenerator::byte;
  using CodeGenerator::word;
  Xbyak::Address byte_of(std::int32_t place) { return byte[rbx + place]; }
  Xbyak::Address dword_of(std::int32_t place) { return dword[rbx + place]; }
  Xbyak::Address ram(unsigned zero_page) { return byte[rbx + layout.ram + static_cast<int>(zero_page & 0x7F)]; }
};

// What eax says when translated code is left: the PC, and whether the interpreter must do the next instruction.
constexpr std::uint32_t kInterpretNext = 1U << 16;

}  // namespace racebeam::translator

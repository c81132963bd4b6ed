// The x86-64 assembler of one batch of blocks, with what the blocks share: the layout of a Board, labels, the
// exit stub.
#pragma once

#include <xbyak/xbyak.h>

#include <cstdint>
#include <unordered_map>

#include "emulator/translator/window.hpp"

namespace racebeam {
class Board;
}

namespace racebeam::translator {

// Offsets in bytes from the start of a Board to the fields that translated code uses. They are the same for
// all Boards.
struct Layout {
  explicit Layout(Board& board);

  std::int32_t ram, a, x, y, sp, cycle, pages, stop, code_span, last_access, slot, sound, pins, cartridge_ram;
  std::int32_t limit, first_line, waited, nz, carry, overflow, decimal, interrupt;
};

class Assembler : public Xbyak::CodeGenerator {
 public:
  // Writes to `memory`. out: the exit stub, which translated code jumps to when it ends. eax then holds the
  // PC, and kInterpretNext if the interpreter must execute the next instruction.
  Assembler(void* memory, std::size_t size, const Layout& places, const Window& seen, const void* out)
      : CodeGenerator(size, memory), layout(places), window(seen), exit_stub(out) {}

  const Layout& layout;
  const Window& window;
  const void* exit_stub;
  std::unordered_map<std::uint16_t, Xbyak::Label> blocks;  // of this batch, by address

  // Whether the window contains the byte at an address.
  bool covers(std::uint16_t address) const { return offset_of(address) < size(); }
  bool covers(std::uint16_t first, unsigned count) const { return offset_of(first) + count <= size(); }
  std::uint8_t byte_at(std::uint16_t address) const { return window.code.memory[offset_of(address)]; }
  unsigned offset_of(std::uint16_t address) const {
    // Bits 15 and 14 are not decoded, so that pages repeat.
    return static_cast<std::uint16_t>((address & 0x3FFF) - (window.code.first & 0x3FFF));
  }
  unsigned size() const { return window.code.span + 2U; }

  using CodeGenerator::byte;
  using CodeGenerator::word;
  Xbyak::Address byte_of(std::int32_t place) { return byte[rbx + place]; }
  Xbyak::Address dword_of(std::int32_t place) { return dword[rbx + place]; }
  Xbyak::Address ram(unsigned zero_page) {
    return byte[rbx + layout.ram + static_cast<int>(zero_page & 0x7F)];
  }
};

// A flag in eax when translated code ends: the interpreter must execute the instruction at PC. The low 16
// bits are the PC.
constexpr std::uint32_t kInterpretNext = 1U << 16;

}  // namespace racebeam::translator

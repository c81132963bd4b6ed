// One decoded 6502 instruction: the row of opcodes.inc, with its operand.
#pragma once

#include <cstdint>

#include "emulator/base/opcodes.hpp"

namespace racebeam::translator {

using opcode::Access;
using opcode::Mode;
using opcode::Operation;

struct Instruction {
  std::uint16_t pc;
  Operation operation;
  Mode mode;
  Access access;
  std::uint8_t length;
  std::uint8_t cycles;    // without the extra ones for crossed pages and taken branches
  std::uint16_t operand;  // one or two bytes, unsigned

  std::uint16_t next() const { return static_cast<std::uint16_t>(pc + length); }

  // The target of a branch, a JMP or a JSR.
  std::uint16_t target() const {
    if (access != Access::Branch) return operand;
    return static_cast<std::uint16_t>(next() + static_cast<std::int8_t>(operand));
  }
};

// Decodes the instruction at `pc`. Three bytes at `bytes` must be readable.
Instruction decode(const std::uint8_t* bytes, std::uint16_t pc);

// True for documented instructions except BRK, PLP and RTI. The interpreter executes all others.
bool is_translatable(const Instruction& instruction);

}  // namespace racebeam::translator

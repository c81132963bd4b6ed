// An interpreter of Thumb code, ARMv4T, for the ARM7TDMI of a cartridge (docs/spec/cartridges.md, 13). Code
// from untrusted images runs within its memory, and within a number of instructions.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/cartridge/arm/memory.hpp"

namespace racebeam::arm {

enum Register : unsigned { kSp = 13, kLr = 14, kPc = 15 };

struct Registers {
  std::array<std::uint32_t, 16> r{};  // between two instructions, kPc is the address of the next one
  bool n = false, z = false, c = false, v = false;
};

enum class Ending : std::uint8_t {
  kReturned,   // it branched to ARM code
  kFault,      // an undefined instruction, or no memory where the code continues
  kOutOfTime,  // all instructions are used up
};

// Runs code from registers.r[kPc] on, until `left` instructions are used up. Subtracts those that were
// executed. A register in a list counts as an instruction.
Ending run(const Memory& memory, Registers& registers, std::uint32_t& left);

}  // namespace racebeam::arm

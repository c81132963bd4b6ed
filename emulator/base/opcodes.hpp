// The length of each instruction: in bytes that are fetched in order, and in cycles without penalties.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace racebeam {

struct Opcode {
  std::uint8_t length;
  std::uint8_t cycles;
};

// JSR counts two bytes: it reads the high byte of its operand after its pushes.
constexpr std::uint8_t opcode_length(std::string_view operation, std::string_view mode) {
  if (operation == "jsr") return 2;
  if (mode == "implied" || mode == "accumulator") return 1;
  return mode.starts_with("absolute") || mode == "indirect" ? 3 : 2;
}

inline constexpr std::array<Opcode, 256> kOpcodes = {{
#define OP(code, operation, mode, access, cycles) {opcode_length(#operation, #mode), cycles},
#include "emulator/base/opcodes.inc"
#undef OP
}};

}  // namespace racebeam

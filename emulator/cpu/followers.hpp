// Which opcodes often follow which. An indirect jump that depends on data costs as much as a handler, and a
// comparison almost nothing. The interpreter therefore tests for these opcodes before it uses its table.
// Counted over 200 frames of each of 104 games. A pair is listed if it makes up at least 0.08 % of all pairs,
// and about a tenth of those after its first opcode.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace racebeam {

constexpr bool is_one_of(std::uint8_t opcode, std::initializer_list<std::uint8_t> opcodes) {
  for (const std::uint8_t one : opcodes)
    if (one == opcode) return true;
  return false;
}

// clang-format off
// The opcodes for which FOLLOWER(opcode) is expanded, the most frequent first.
#define RACEBEAM_FOLLOWERS(FOLLOWER) \
  FOLLOWER(85) FOLLOWER(D0) FOLLOWER(10) FOLLOWER(B1) FOLLOWER(90) FOLLOWER(B0) FOLLOWER(F0) FOLLOWER(A5) \
  FOLLOWER(84) FOLLOWER(86) FOLLOWER(E5) FOLLOWER(B9) FOLLOWER(0A) FOLLOWER(4A) FOLLOWER(EA)

constexpr bool often_follows(std::uint8_t opcode, std::uint8_t before) {
  switch (opcode) {
    case 0x85: return true;  // STA zp: more than a fifth of all instructions
    case 0xD0: return is_one_of(before, {0xCA, 0x88, 0x29, 0xC4, 0xC6, 0xC0, 0xAD, 0xE0, 0xC9, 0xE4, 0xD5, 0xC5, 0xE8});
    case 0x10: return is_one_of(before, {0x88, 0xCA, 0xC6, 0x24});
    case 0xB1: return is_one_of(before, {0x85, 0xA4, 0xAA, 0xA8});
    case 0x90: return is_one_of(before, {0xC9, 0xC4, 0xC0, 0xE0});
    case 0xB0: return is_one_of(before, {0xE9, 0xC0, 0xC9, 0xC4, 0xE0, 0xC5});
    case 0xF0: return is_one_of(before, {0xC9, 0x29, 0xC0});
    case 0xA5: return is_one_of(before, {0x85, 0xC6, 0xA8, 0x30, 0xA0, 0x38, 0x08});
    case 0x84: return is_one_of(before, {0x84, 0x86, 0xA0});
    case 0x86: return is_one_of(before, {0x86, 0xA2, 0xA6});
    case 0xE5: return is_one_of(before, {0x38, 0x8A});
    case 0xB9: return is_one_of(before, {0xA4, 0xA8});
    case 0x0A: case 0x4A: case 0xEA: return before == opcode;
    default: return false;
  }
}
// clang-format on

}  // namespace racebeam

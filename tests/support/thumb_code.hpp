// An assembler for Thumb code in tests: each function returns an instruction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace racebeam::test::thumb {

using Code = std::uint16_t;

constexpr unsigned kLr = 14, kPc = 15;

constexpr Code code(unsigned bits) { return static_cast<Code>(bits); }

// Registers 0 to 7, and numbers that fit.
constexpr Code lsl(unsigned d, unsigned s, unsigned by) { return code(by << 6 | s << 3 | d); }
constexpr Code lsr(unsigned d, unsigned s, unsigned by) { return code(0x0800 | by << 6 | s << 3 | d); }
constexpr Code asr(unsigned d, unsigned s, unsigned by) { return code(0x1000 | by << 6 | s << 3 | d); }
constexpr Code add(unsigned d, unsigned a, unsigned b) { return code(0x1800 | b << 6 | a << 3 | d); }
constexpr Code sub(unsigned d, unsigned a, unsigned b) { return code(0x1A00 | b << 6 | a << 3 | d); }
constexpr Code mov_number(unsigned d, unsigned n) { return code(0x2000 | d << 8 | n); }
constexpr Code cmp_number(unsigned d, unsigned n) { return code(0x2800 | d << 8 | n); }
constexpr Code add_number(unsigned d, unsigned n) { return code(0x3000 | d << 8 | n); }
constexpr Code sub_number(unsigned d, unsigned n) { return code(0x3800 | d << 8 | n); }

// clang-format off
enum Operation : unsigned { kAnd, kEor, kLsl, kLsr, kAsr, kAdc, kSbc, kRor, kTst, kNeg, kCmp, kCmn, kOrr, kMul, kBic, kMvn };
// clang-format on
constexpr Code alu(Operation operation, unsigned d, unsigned s) {
  return code(0x4000 | unsigned{operation} << 6 | s << 3 | d);
}

// Any registers.
constexpr Code any(unsigned bits, unsigned d, unsigned s) {
  return code(bits | (d >> 3) << 7 | s << 3 | (d & 7));
}
constexpr Code add_any(unsigned d, unsigned s) { return any(0x4400, d, s); }
constexpr Code cmp_any(unsigned d, unsigned s) { return any(0x4500, d, s); }
constexpr Code mov_any(unsigned d, unsigned s) { return any(0x4600, d, s); }
constexpr Code bx(unsigned s) { return code(0x4700 | s << 3); }

// A register, and the number at a base register plus `at`.
constexpr Code str(unsigned d, unsigned base, unsigned at) {
  return code(0x6000 | at / 4 << 6 | base << 3 | d);
}
constexpr Code ldr(unsigned d, unsigned base, unsigned at) {
  return code(0x6800 | at / 4 << 6 | base << 3 | d);
}
constexpr Code strb(unsigned d, unsigned base, unsigned at) { return code(0x7000 | at << 6 | base << 3 | d); }
constexpr Code ldrb(unsigned d, unsigned base, unsigned at) { return code(0x7800 | at << 6 | base << 3 | d); }
constexpr Code strh(unsigned d, unsigned base, unsigned at) {
  return code(0x8000 | at / 2 << 6 | base << 3 | d);
}
constexpr Code ldrh(unsigned d, unsigned base, unsigned at) {
  return code(0x8800 | at / 2 << 6 | base << 3 | d);
}
constexpr Code ldr_near(unsigned d, unsigned at) { return code(0x4800 | d << 8 | at / 4); }  // from PC on

// The lists are bit sets.
constexpr Code push(unsigned list, bool lr) { return code(0xB400 | unsigned{lr} << 8 | list); }
constexpr Code pop(unsigned list, bool pc) { return code(0xBC00 | unsigned{pc} << 8 | list); }
constexpr Code stmia(unsigned base, unsigned list) { return code(0xC000 | base << 8 | list); }
constexpr Code ldmia(unsigned base, unsigned list) { return code(0xC800 | base << 8 | list); }

// Branches over `distance` bytes, counted from the branch.
enum Condition : unsigned { kEq, kNe, kCs, kCc, kMi, kPl, kVs, kVc, kHi, kLs, kGe, kLt, kGt, kLe };
constexpr Code branch_if(Condition condition, int distance) {
  return code(0xD000 | unsigned{condition} << 8 | (static_cast<unsigned>(distance - 4) >> 1 & 0xFF));
}
constexpr Code branch(int distance) {
  return code(0xE000 | (static_cast<unsigned>(distance - 4) >> 1 & 0x7FF));
}

constexpr Code kForEver = branch(0);

// Puts the code into `bytes` at offset `at`.
inline void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::initializer_list<Code> program) {
  for (const Code one : program) {
    bytes[at++] = static_cast<std::uint8_t>(one & 0xFF);
    bytes[at++] = static_cast<std::uint8_t>(one >> 8);
  }
}

}  // namespace racebeam::test::thumb

// The registers of the TIA that are written: their addresses, and the columns of registers.inc except for the
// bytes (register_bytes.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace racebeam {

enum TiaRegister : std::uint8_t {
#define REGISTER(name, ...) name,
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
  kTiaRegisters,  // their number; addresses from here to kNone have no register
  kNone = 0x3F,
};

enum class RegisterUse : std::uint8_t { kUnused, kSync, kSound, kPicture };
enum class OnRepeat : bool { kHolds, kActs };
enum class WhenLate : bool { kNext, kOwn };

struct RegisterTraits {
  RegisterUse use = RegisterUse::kUnused;
  std::int32_t delay = 0;  // colour clocks, at most
  OnRepeat repeat = OnRepeat::kActs;
  WhenLate late = WhenLate::kNext;
  TiaRegister renews = kNone;
  std::uint8_t bits = 0;
};

inline constexpr auto kRegisters = [] {  // by address bits 5-0
  std::array<RegisterTraits, 64> table{};
#define REGISTER(name, use, delay, repeat, late, renews, bits, sets, may_set, reads) \
  table[name] = {RegisterUse::k##use, delay, OnRepeat::k##repeat, WhenLate::k##late, renews, bits};
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
  return table;
}();

// The bits of a written value that the register keeps. Only they are logged.
constexpr std::uint8_t logged_bits(unsigned reg) { return kRegisters[reg].bits; }

constexpr bool is_sound(unsigned reg) { return kRegisters[reg].use == RegisterUse::kSound; }

// In sets of registers.
constexpr std::uint64_t register_bit(unsigned reg) { return std::uint64_t{1} << reg; }

// The registers whose writes may change the picture.
inline constexpr std::uint64_t kPictureRegisters = [] {
  std::uint64_t registers = 0;
  for (unsigned reg = 0; reg < kRegisters.size(); ++reg)
    if (kRegisters[reg].use == RegisterUse::kPicture) registers |= register_bit(reg);
  return registers;
}();

// Colour clocks that a write may draw ahead of its own.
inline constexpr std::int32_t kLongestDelay =
    std::max_element(kRegisters.begin(), kRegisters.end(),
                     [](const auto& a, const auto& b) { return a.delay < b.delay; }) -> delay;

}  // namespace racebeam

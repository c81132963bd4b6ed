// Addressing modes. Each makes its own bus reads, and returns the effective address (docs/spec/cpu.md, 4).
// kPenalty: the instruction only reads, so that a crossed page costs a cycle.
#pragma once

#include "emulator/cpu/core.hpp"

namespace racebeam::mode {

using Address = std::uint16_t;

template <bool kPenalty>
RACEBEAM_INLINE Address indexed(Core& cpu, Address base, std::uint8_t index) {
  if (kPenalty) cpu.add_penalty((base & 0xFFU) + index);
  return static_cast<Address>(base + index);
}

// A pointer in the zero page. Its high byte is read from p+1, which is $0100 if p is $FF.
RACEBEAM_INLINE Address pointer(Core& cpu, std::uint8_t p) {
  if (p >= 0x80 && p != 0xFF) [[likely]]
    return cpu.read_word_of_ram(p);
  const std::uint8_t low = cpu.read(ZeroPage{p});
  if (p == 0xFF) return static_cast<Address>(low | cpu.read(0x0100) << 8);
  return static_cast<Address>(low | cpu.read(ZeroPage{static_cast<std::uint8_t>(p + 1)}) << 8);
}

// These have no address. opcodes.inc needs their names.
// clang-format off
template <bool> RACEBEAM_INLINE Address implied(Core&) { return 0; }
template <bool> RACEBEAM_INLINE Address accumulator(Core&) { return 0; }
template <bool> RACEBEAM_INLINE Address relative(Core&) { return 0; }
template <bool> RACEBEAM_INLINE Address immediate(Core&) { return 0; }
// clang-format on

template <bool>
RACEBEAM_INLINE ZeroPage zero_page(Core& cpu) {
  return {cpu.fetch()};
}
template <bool>
RACEBEAM_INLINE ZeroPage zero_page_x(Core& cpu) {
  return {static_cast<std::uint8_t>(cpu.fetch() + cpu.X)};
}
template <bool>
RACEBEAM_INLINE ZeroPage zero_page_y(Core& cpu) {
  return {static_cast<std::uint8_t>(cpu.fetch() + cpu.Y)};
}
template <bool>
RACEBEAM_INLINE Address absolute(Core& cpu) {
  return cpu.fetch_word();
}
template <bool kPenalty>
RACEBEAM_INLINE Address absolute_x(Core& cpu) {
  return indexed<kPenalty>(cpu, cpu.fetch_word(), cpu.X);
}
template <bool kPenalty>
RACEBEAM_INLINE Address absolute_y(Core& cpu) {
  return indexed<kPenalty>(cpu, cpu.fetch_word(), cpu.Y);
}
template <bool>
RACEBEAM_INLINE Address indirect_x(Core& cpu) {
  return pointer(cpu, static_cast<std::uint8_t>(cpu.fetch() + cpu.X));
}
template <bool kPenalty>
RACEBEAM_INLINE Address indirect_y(Core& cpu) {
  return indexed<kPenalty>(cpu, pointer(cpu, cpu.fetch()), cpu.Y);
}
// JMP (q): both bytes come from the same page.
template <bool>
RACEBEAM_INLINE Address indirect(Core& cpu) {
  const Address q = cpu.fetch_word();
  const std::uint8_t low = cpu.read(q);
  return static_cast<Address>(low | cpu.read(static_cast<Address>((q & 0xFF00) | ((q + 1) & 0xFF))) << 8);
}

}  // namespace racebeam::mode

// Which bytes of TiaRegisters a write sets and reads: the last columns of registers.inc as masks, with $FF
// for each byte.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "emulator/state/state.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam {

struct RegisterBytes {
  TiaRegisters sets, may_set, reads;
};

namespace detail {

template <class... Byte>
constexpr void mark(Byte&... byte) {
  ((byte = static_cast<Byte>(0xFF)), ...);
}

}  // namespace detail

// The mask of bytes listed in parentheses by their names in TiaRegisters; p0, p1, m0, m1 are players and
// missiles.
#define RACEBEAM_TIA_BYTES(bytes)                                                                          \
  [] {                                                                                                     \
    TiaRegisters mask{};                                                                                   \
    [[maybe_unused]] auto& [color, ctrlpf, reflect, pf, player, missile, ball, vblank, comb_armed, cosmic, \
                            cosmic_count, cosmic_shape, enabled, spare] = mask;                            \
    [[maybe_unused]] auto& [p0, p1] = player;                                                              \
    [[maybe_unused]] auto& [m0, m1] = missile;                                                             \
    detail::mark bytes;                                                                                    \
    return mask;                                                                                           \
  }()

inline constexpr auto kRegisterBytes = [] {  // by address bits 5-0
  std::array<RegisterBytes, 64> table{};
#define REGISTER(name, use, delay, repeat, late, renews, sets, may_set, reads) \
  table[name] = {RACEBEAM_TIA_BYTES(sets), RACEBEAM_TIA_BYTES(may_set), RACEBEAM_TIA_BYTES(reads)};
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
  return table;
}();

using TiaBytes = std::array<std::uint8_t, sizeof(TiaRegisters)>;

constexpr bool share_a_byte(const TiaRegisters& a, const TiaRegisters& b) {
  const auto left = std::bit_cast<TiaBytes>(a), right = std::bit_cast<TiaBytes>(b);
  for (std::size_t i = 0; i < left.size(); ++i)
    if ((left[i] & right[i]) != 0) return true;
  return false;
}

constexpr TiaRegisters operator|(const TiaRegisters& a, const TiaRegisters& b) {
  auto bytes = std::bit_cast<TiaBytes>(a);
  const auto more = std::bit_cast<TiaBytes>(b);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] |= more[i];
  return std::bit_cast<TiaRegisters>(bytes);
}

}  // namespace racebeam

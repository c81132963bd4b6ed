// Sets of bytes of TiaRegisters: as masks, with $FF for each byte, and with one bit for each byte.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

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

// A bit for each byte of TiaRegisters.
using ByteSet = std::uint64_t;

constexpr ByteSet set_of(const TiaRegisters& mask) {
  const auto bytes = std::bit_cast<TiaBytes>(mask);
  ByteSet set = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) set |= ByteSet{bytes[i] != 0} << i;
  return set;
}

#define RACEBEAM_TIA_BYTE_SET(bytes) set_of(RACEBEAM_TIA_BYTES(bytes))

}  // namespace racebeam

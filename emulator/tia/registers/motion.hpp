// How far HMOVE moves an object: a table by the cycle of the strobe within its line and the motion nibble
// (docs/spec/tia.md, 9).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace racebeam {

constexpr int kLineCycles = 76;

namespace detail {

// For cycles 0-20, the largest movement to the left for which time remains.
constexpr std::array<std::int8_t, 21> kEarlyLimit = {7, 7, 7,  7,  6,  5,  5,  4,  3,  2, 2,
                                                     1, 0, -1, -1, -2, -3, -4, -4, -5, -6};
// For cycles 55-74, the amount by which a late strobe reduces the movement to the left.
constexpr std::array<std::int8_t, 20> kLateLoss = {6,  5,  4,  4,  3,  2,  1,  1,  0,  -1,
                                                   -2, -2, -3, -4, -5, -5, -6, -7, -8, -8};

constexpr std::int8_t movement(int cycle, int nibble) {
  const int left = nibble < 8 ? nibble : nibble - 16;
  if (cycle == 75) cycle = 0;
  if (cycle <= 20)
    return static_cast<std::int8_t>(-std::min<int>(left, kEarlyLimit[static_cast<std::size_t>(cycle)]));
  if (cycle <= 54) return 0;
  return static_cast<std::int8_t>(-std::max<int>(0, left - kLateLoss[static_cast<std::size_t>(cycle - 55)]));
}

constexpr auto make_movements() {
  std::array<std::array<std::int8_t, 16>, kLineCycles> table{};
  for (int cycle = 0; cycle < kLineCycles; ++cycle)
    for (int nibble = 0; nibble < 16; ++nibble)
      table[static_cast<std::size_t>(cycle)][static_cast<std::size_t>(nibble)] = movement(cycle, nibble);
  return table;
}

}  // namespace detail

inline constexpr auto kMovement = detail::make_movements();  // [cycle 0-75][HMxx >> 4]: added to the position

}  // namespace racebeam

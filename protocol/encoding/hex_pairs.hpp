// The two hexadecimal digits of each byte.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace racebeam {

static_assert(std::endian::native == std::endian::little, "the first digit is the low half of a pair");

inline constexpr std::array<std::uint16_t, 256> kHexPairs = [] {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::array<std::uint16_t, 256> pairs{};
  for (std::size_t byte = 0; byte < pairs.size(); ++byte)
    pairs[byte] = static_cast<std::uint16_t>(kDigits[byte / 16] | kDigits[byte % 16] << 8);
  return pairs;
}();

}  // namespace racebeam

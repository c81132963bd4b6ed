// The common parts of hexadecimal and run-length text, and the versions for each processor: text_x86.cpp,
// text_neon.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "emulator/base/simd.hpp"
#include "protocol/encoding/hex_pairs.hpp"

namespace racebeam {

inline constexpr std::size_t kRow = 160;

struct RowFacts {
  std::array<std::uint32_t, 5> begins;  // bit i of all words: pixel i differs from the one before it
  std::uint32_t repeats;                // 1: the row equals the one above
};

// Find the facts of `count` rows. Each must have a row before it.
void find_avx2(const std::uint8_t* row, std::size_t count, RowFacts* facts);
void find_neon(const std::uint8_t* row, std::size_t count, RowFacts* facts);

// Write two digits for each byte.
inline void write_hex_plain(char* to, const std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + 2 * i, &kHexPairs[bytes[i]], 2);
}

void write_hex_avx2(char* to, const std::uint8_t* bytes, std::size_t count);
void write_hex_neon(char* to, const std::uint8_t* bytes, std::size_t count);

}  // namespace racebeam

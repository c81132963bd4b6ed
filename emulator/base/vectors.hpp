// Vectors of sixteen bytes, by an extension of the compiler. They work on every processor, with x86-64's
// baseline instructions or similar ones.
#pragma once

#include <cstdint>
#include <cstring>

#include "emulator/base/inlining.hpp"

namespace racebeam {

using TwoWords [[gnu::vector_size(16)]] = std::uint64_t;
using FourWords [[gnu::vector_size(16)]] = std::uint32_t;

// Loads from any address.
template <class Vector>
RACEBEAM_INLINE Vector load(const void* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}

RACEBEAM_INLINE bool is_zero(TwoWords words) { return (words[0] | words[1]) == 0; }

// Returns a bit for each byte: its uppermost bit.
RACEBEAM_INLINE std::uint32_t top_bits(TwoWords words) {
#ifdef __SSE2__
  using Bytes [[gnu::vector_size(16)]] = char;
  return static_cast<std::uint32_t>(__builtin_ia32_pmovmskb128(reinterpret_cast<Bytes>(words)));
#else
  const auto bits = [](std::uint64_t word) {
    return (word >> 7 & 0x0101010101010101) * 0x0102040810204080 >> 56;
  };
  return static_cast<std::uint32_t>(bits(words[0]) | bits(words[1]) << 8);
#endif
}

}  // namespace racebeam

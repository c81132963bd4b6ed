// Sixteen bytes at a time, as every x86-64 and most other processors have instructions for: vectors of the compiler, not
// of a processor.
#pragma once

#include <cstdint>
#include <cstring>

#include "emulator/inlining.hpp"

namespace racebeam {

using TwoWords [[gnu::vector_size(16)]] = std::uint64_t;
using FourWords [[gnu::vector_size(16)]] = std::uint32_t;

// From anywhere in memory.
template <class Vector>
RACEBEAM_INLINE Vector load(const void* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof vector);
  return vector;
}

RACEBEAM_INLINE bool is_zero(TwoWords words) { return (words[0] | words[1]) == 0; }

}  // namespace racebeam

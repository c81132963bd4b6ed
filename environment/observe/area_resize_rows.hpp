// Adds reduced rows. Each form of AreaResize inlines this, and compiles it for its processors.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

#include "environment/observe/area_resize.hpp"

namespace racebeam {

inline constexpr std::size_t kSlots = 32;  // reduced rows in the ring: more than a target has taps

// Rounds half to even, as the processor does: from 1.5 * 2^23 on, a float's last bit is worth 1.
inline std::uint8_t rounded(float value) {
  return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(value + 12582912.0F));
}

[[gnu::always_inline]] inline bool same_row(const std::uint8_t* a, const std::uint8_t* b, std::size_t size) {
  std::uint64_t difference = 0, left, right;
  for (; size >= 8; size -= 8, a += 8, b += 8) {
    std::memcpy(&left, a, 8);
    std::memcpy(&right, b, 8);
    difference |= left ^ right;
  }
  return difference == 0 && std::memcmp(a, b, size) == 0;
}

// Each source row is reduced to the targets' width, then rows are added. Repeated rows are common.
template <typename Reduce>
[[gnu::always_inline]] inline void AreaResize::run(const std::uint8_t* in, std::uint8_t* out,
                                                   std::span<const std::uint8_t> rows, Reduce reduce) const {
  alignas(32) std::array<std::array<float, kWidest>, kSlots> slots;
  alignas(32) std::array<float, kWidest> sum;
  std::array<const float*, kSlots> reduced{};  // source row y: reduced[y % kSlots]
  std::size_t end = 0, begin = 0, slot = 0;    // the rows from `begin` to `end` are reduced
  const std::size_t targets = columns_.first.size();
  for (std::size_t y = 0; y < rows_.first.size(); ++y, out += targets) {
    if (!rows.empty() && rows[y] == 0) continue;
    const std::size_t first = rows_.first[y];
    if (end < first) end = begin = first;
    std::fill_n(sum.data(), targets, 0.0F);
    for (std::size_t tap = 0; tap < rows_.taps; ++tap) {
      const float weight = rows_.weights[y * rows_.taps + tap];
      if (weight == 0) continue;
      for (; end <= first + tap; ++end) {
        const std::uint8_t* row = in + end * width_;
        if (end > begin && same_row(row, row - width_, width_)) {
          reduced[end % kSlots] = reduced[(end - 1) % kSlots];
        } else {
          reduced[end % kSlots] = slots[slot].data();
          reduce(row, slots[slot].data());
          slot = (slot + 1) % kSlots;
        }
      }
      const float* const row = reduced[(first + tap) % kSlots];
      for (std::size_t x = 0; x < targets; ++x) sum[x] += weight * row[x];
    }
    for (std::size_t x = 0; x < targets; ++x) out[x] = rounded(sum[x]);
  }
}

}  // namespace racebeam

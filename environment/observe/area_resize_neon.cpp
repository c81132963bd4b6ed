// The area average with NEON.
#include <arm_neon.h>

#include "environment/observe/area_resize_rows.hpp"

namespace racebeam {

void AreaResize::reduce_neon(const std::uint8_t* row, float* to) const {
  for (const Octet& octet : octets_) {
    const uint8x16_t cells[2] = {vld1q_u8(row + octet.from[0]), vld1q_u8(row + octet.from[1])};
    float32x4_t sum[2] = {vdupq_n_f32(0), vdupq_n_f32(0)};
    for (std::size_t tap = 0; tap < octet.places.size(); ++tap) {
      for (std::size_t half = 0; half < 2; ++half) {
        const uint8x16_t places = vld1q_u8(octet.places[tap].data() + 16 * half);
        const float32x4_t cell = vcvtq_f32_u32(vreinterpretq_u32_u8(vqtbl1q_u8(cells[half], places)));
        sum[half] = vaddq_f32(sum[half], vmulq_f32(cell, vld1q_f32(octet.weights[tap].data() + 4 * half)));
      }
    }
    vst1q_f32(to, sum[0]);
    vst1q_f32(to + 4, sum[1]);
    to += 8;
  }
}

void AreaResize::run_neon(const std::uint8_t* in, std::uint8_t* out,
                          std::span<const std::uint8_t> rows) const {
  run(in, out, rows, [this](const std::uint8_t* row, float* to) { reduce_neon(row, to); });
}

}  // namespace racebeam

// Pixels with NEON: 16 at a time, where a layer covers some of them.
#include <arm_neon.h>

#include <bit>

#include "emulator/tia/line/pixel_layers.hpp"

namespace racebeam {
namespace {

void paint(std::uint8_t* row, std::uint64_t covered, std::uint8_t color) {
  if (covered == 0) return;
  const uint8x16_t ink = vdupq_n_u8(color);
  const uint8x16_t bit_of_each = vreinterpretq_u8_u64(vdupq_n_u64(0x8040201008040201));
  const uint8x16_t byte_of_each = vcombine_u8(vdup_n_u8(0), vdup_n_u8(1));
  do {
    const int at = std::countr_zero(covered) & ~15;
    const uint8x16_t bits = vqtbl1q_u8(vreinterpretq_u8_u64(vdupq_n_u64(covered >> at)), byte_of_each);
    vst1q_u8(row + at, vbslq_u8(vtstq_u8(bits, bit_of_each), ink, vld1q_u8(row + at)));
    covered &= ~(std::uint64_t{0xFFFF} << at);
  } while (covered != 0);
}

}  // namespace

void draw_neon(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  draw_layers(line, tia, row, first, last, paint);
}

}  // namespace racebeam

// Hexadecimal and run-length text with NEON: 16 or 32 bytes at a time.
#include <arm_neon.h>

#include "protocol/encoding/text_forms.hpp"

namespace racebeam {
namespace {

// Bit i: byte i of both is not zero. All bytes are zeros or ones.
std::uint32_t bits_of(uint8x16_t low, uint8x16_t high) {
  const uint8x16_t bit_of_each = vreinterpretq_u8_u64(vdupq_n_u64(0x8040201008040201));
  uint8x16_t sums = vpaddq_u8(vandq_u8(low, bit_of_each), vandq_u8(high, bit_of_each));
  sums = vpaddq_u8(sums, sums);
  sums = vpaddq_u8(sums, sums);
  return vgetq_lane_u32(vreinterpretq_u32_u8(sums), 0);
}

}  // namespace

void find_neon(const std::uint8_t* row, std::size_t count, RowFacts* facts) {
  for (; count > 0; --count, row += kRow, ++facts) {
    uint8x16_t differences = vdupq_n_u8(0);
    for (std::size_t i = 0; i < kRow; i += 32) {
      const uint8x16_t low = vld1q_u8(row + i), high = vld1q_u8(row + i + 16);
      facts->begins[i / 32] = bits_of(vmvnq_u8(vceqq_u8(low, vld1q_u8(row + i - 1))),
                                      vmvnq_u8(vceqq_u8(high, vld1q_u8(row + i + 15))));
      differences = vorrq_u8(differences, veorq_u8(low, vld1q_u8(row + i - kRow)));
      differences = vorrq_u8(differences, veorq_u8(high, vld1q_u8(row + i + 16 - kRow)));
    }
    facts->repeats = vmaxvq_u8(differences) == 0 ? 1 : 0;
  }
}

void write_hex_neon(char* to, const std::uint8_t* bytes, std::size_t count) {
  const uint8x16_t digits = vld1q_u8(reinterpret_cast<const std::uint8_t*>("0123456789ABCDEF"));
  std::size_t i = 0;
  for (; i + 16 <= count; i += 16) {
    const uint8x16_t both = vld1q_u8(bytes + i);
    const uint8x16x2_t pairs = {vqtbl1q_u8(digits, vshrq_n_u8(both, 4)),
                                vqtbl1q_u8(digits, vandq_u8(both, vdupq_n_u8(0x0F)))};
    vst2q_u8(reinterpret_cast<std::uint8_t*>(to) + 2 * i, pairs);
  }
  write_hex_plain(to + 2 * i, bytes + i, count - i);
}

}  // namespace racebeam

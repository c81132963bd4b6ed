// Brightness with NEON.
#include <arm_neon.h>

#include "environment/observe/brightness_plain.hpp"

namespace racebeam {

struct Brightness::Neon {
  static constexpr std::size_t kRow = kLinePixels;

  // The even entries of the table: 64 and 64.
  struct Halves {
    uint8x16x4_t low, high;
  };

  static uint8x16x4_t even_entries(const std::uint8_t* table) {
    return {vld2q_u8(table).val[0], vld2q_u8(table + 32).val[0], vld2q_u8(table + 64).val[0],
            vld2q_u8(table + 96).val[0]};
  }

  // Looks up even indices. An index beyond a half selects nothing of it.
  static uint8x16_t look_up(const Halves& table, uint8x16_t pixels) {
    const uint8x16_t entry = vshrq_n_u8(pixels, 1);
    return vqtbx4q_u8(vqtbl4q_u8(table.low, entry), table.high, vsubq_u8(entry, vdupq_n_u8(64)));
  }

  template <std::size_t pictures>
  static void make(const Brightness& own, const Rows<pictures>& rows, std::uint8_t* to) {
    const Halves table{even_entries(own.table_->data()), even_entries(own.table_->data() + 128)};
    uint8x16_t all = vdupq_n_u8(0);
    for (std::size_t x = 0; x < kRow; x += 16) {
      const uint8x16_t pixels = vld1q_u8(rows[0] + x);
      uint8x16_t bytes = look_up(table, pixels);
      all = vorrq_u8(all, pixels);
      if constexpr (pictures == 2) {
        const uint8x16_t others = vld1q_u8(rows[1] + x);
        bytes = vmaxq_u8(bytes, look_up(table, others));
        all = vorrq_u8(all, others);
      }
      vst1q_u8(to + x, bytes);
    }
    if (vmaxvq_u8(vandq_u8(all, vdupq_n_u8(1))) != 0) Plain::make<pictures>(own, rows, to);
  }
};

void Brightness::use_neon() {
  make_ = Neon::make<1>;
  make_brighter_ = Neon::make<2>;
}

}  // namespace racebeam

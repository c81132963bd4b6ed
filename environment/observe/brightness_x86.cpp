// Brightness with AVX2 and with AVX512_VBMI.
#include <immintrin.h>

#include "environment/observe/brightness_plain.hpp"

#if RACEBEAM_HAS_AVX

#define RACEBEAM_AVX2 [[gnu::target("avx2")]]
#define RACEBEAM_VBMI [[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi")]]

namespace racebeam {

// Most of a row is background. The form of AVX2 therefore copies a group of pixels that equals the last
// group.
struct Brightness::X86 {
  static constexpr std::size_t kRow = kLinePixels;

  // Looks up even indices: half of each is 16 * n + i. Entry i of the first n + 1 steps makes the byte, since
  // a shuffle gives 0 once what is left of the index is negative.
  RACEBEAM_AVX2 static __m256i look_up_even(const Brightness& own, __m256i pixels) {
    __m256i rest = _mm256_srli_epi16(pixels, 1), bytes = _mm256_setzero_si256();
    for (const auto& step : own.steps_) {
      const __m128i entries = _mm_load_si128(reinterpret_cast<const __m128i*>(step.data()));
      bytes = _mm256_xor_si256(bytes, _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(entries), rest));
      rest = _mm256_sub_epi8(rest, _mm256_set1_epi8(16));
    }
    return bytes;
  }

  template <std::size_t pictures>
  RACEBEAM_AVX2 static void avx2(const Brightness& own, const Rows<pictures>& rows, std::uint8_t* to) {
    __m256i last[pictures] = {}, bytes = _mm256_set1_epi8(static_cast<char>(own.of(0)));
    for (std::size_t x = 0; x < kRow; x += 32) {
      __m256i pixels[pictures], all = _mm256_setzero_si256(), changes = all;
      for (std::size_t i = 0; i < pictures; ++i) {
        pixels[i] = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(rows[i] + x));
        all = _mm256_or_si256(all, pixels[i]);
        changes = _mm256_or_si256(changes, _mm256_xor_si256(pixels[i], last[i]));
        last[i] = pixels[i];
      }
      if (_mm256_testz_si256(changes, changes) == 0) {
        if (_mm256_testz_si256(all, _mm256_set1_epi8(1)) == 0) return Plain::make<pictures>(own, rows, to);
        bytes = look_up_even(own, pixels[0]);
        if constexpr (pictures == 2) bytes = _mm256_max_epu8(bytes, look_up_even(own, pixels[1]));
      }
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + x), bytes);
    }
  }

  // The table's entries by 64.
  struct Quarters {
    __m512i first, second, third, fourth;
  };

  RACEBEAM_VBMI static __m512i look_up(const Quarters& table, __m512i pixels) {
    const __m512i low = _mm512_permutex2var_epi8(table.first, pixels, table.second);
    const __m512i high = _mm512_permutex2var_epi8(table.third, pixels, table.fourth);
    return _mm512_mask_blend_epi8(_mm512_movepi8_mask(pixels), low, high);
  }

  template <std::size_t pictures>
  RACEBEAM_VBMI static void vbmi(const Brightness& own, const Rows<pictures>& rows, std::uint8_t* to) {
    const std::uint8_t* const entries = own.table_->data();
    const Quarters table{_mm512_loadu_si512(entries), _mm512_loadu_si512(entries + 64),
                         _mm512_loadu_si512(entries + 128), _mm512_loadu_si512(entries + 192)};
    for (std::size_t x = 0; x < kRow; x += 64) {
      const __mmask64 inside = ~std::uint64_t{0} >> (x + 64 > kRow ? x + 64 - kRow : 0);
      __m512i bytes = look_up(table, _mm512_maskz_loadu_epi8(inside, rows[0] + x));
      if constexpr (pictures == 2)
        bytes = _mm512_max_epu8(bytes, look_up(table, _mm512_maskz_loadu_epi8(inside, rows[1] + x)));
      _mm512_mask_storeu_epi8(to + x, inside, bytes);
    }
  }
};

void Brightness::use_x86(Simd form) {
  if (form == Simd::kAvx512 && has_vbmi()) {
    make_ = X86::vbmi<1>;
    make_brighter_ = X86::vbmi<2>;
  } else {
    make_steps();
    make_ = X86::avx2<1>;
    make_brighter_ = X86::avx2<2>;
  }
}

void Brightness::make_steps() {
  for (std::size_t entry = 0; entry < 128; ++entry) {
    const std::uint8_t before = entry < 16 ? 0 : (*table_)[2 * (entry - 16)];
    steps_[entry / 16][entry % 16] = (*table_)[2 * entry] ^ before;
  }
}

}  // namespace racebeam

#endif

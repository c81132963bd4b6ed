#include "environment/observe/brightness.hpp"

#include <algorithm>
#include <cstring>

#include "emulator/tia/line/pixel_mask.hpp"

#if RACEBEAM_HAS_AVX
#include <immintrin.h>
#endif

namespace racebeam {

// Most of a row is background. All forms but that of AVX-512 therefore copy a group of pixels that equals the
// last group.
struct Brightness::Forms {
  static constexpr std::size_t kRow = kLinePixels;

  template <std::size_t pictures>
  static std::uint8_t brightest(const Brightness& own, const Rows<pictures>& rows, std::size_t x) {
    std::uint8_t most = own.of(rows[0][x]);
    if constexpr (pictures == 2) most = std::max(most, own.of(rows[1][x]));
    return most;
  }

  template <std::size_t pictures>
  static void plain(const Brightness& own, const Rows<pictures>& rows, std::uint8_t* to) {
    std::array<std::uint64_t, pictures> last{};
    std::array<std::uint8_t, 8> bytes;
    bytes.fill(own.of(0));
    for (std::size_t x = 0; x < kRow; x += 8) {
      std::array<std::uint64_t, pictures> pixels;
      for (std::size_t i = 0; i < pictures; ++i) std::memcpy(&pixels[i], rows[i] + x, 8);
      if (pixels != last) {
        for (std::size_t i = 0; i < 8; ++i) bytes[i] = brightest<pictures>(own, rows, x + i);
        last = pixels;
      }
      std::memcpy(to + x, bytes.data(), 8);
    }
  }

#if RACEBEAM_HAS_AVX
#define RACEBEAM_AVX2 [[gnu::target("avx2")]]
#define RACEBEAM_VBMI [[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi")]]

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
        if (_mm256_testz_si256(all, _mm256_set1_epi8(1)) == 0) return plain<pictures>(own, rows, to);
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
#endif
};

bool Brightness::has_vbmi() {
#if RACEBEAM_HAS_AVX
  return best_simd() == Simd::kAvx512 && __builtin_cpu_supports("avx512vbmi") != 0;
#else
  return false;
#endif
}

Brightness::Brightness(const BrightnessTable& table, Simd form)
    : table_(&table), make_(Forms::plain<1>), make_brighter_(Forms::plain<2>) {
#if RACEBEAM_HAS_AVX
  if (form == Simd::kAvx512 && has_vbmi()) {
    make_ = Forms::vbmi<1>;
    make_brighter_ = Forms::vbmi<2>;
  } else if (form >= Simd::kAvx2) {
    make_steps(table);
    make_ = Forms::avx2<1>;
    make_brighter_ = Forms::avx2<2>;
  }
#endif
  static_cast<void>(form);
}

void Brightness::make_steps(const BrightnessTable& table) {
  for (std::size_t entry = 0; entry < 128; ++entry) {
    const std::uint8_t before = entry < 16 ? 0 : table[2 * (entry - 16)];
    steps_[entry / 16][entry % 16] = table[2 * entry] ^ before;
  }
}

}  // namespace racebeam

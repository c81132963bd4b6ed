// Hexadecimal and run-length text with AVX2: 32 bytes at a time.
#include <immintrin.h>

#include "protocol/encoding/text_forms.hpp"

#if RACEBEAM_HAS_AVX

namespace racebeam {

[[gnu::target("avx2")]] void find_avx2(const std::uint8_t* row, std::size_t count, RowFacts* facts) {
  for (; count > 0; --count, row += kRow, ++facts) {
    __m256i differences = _mm256_setzero_si256();
    for (std::size_t i = 0; i < kRow; i += 32) {
      const auto* const here = reinterpret_cast<const __m256i*>(row + i);
      const auto* const before = reinterpret_cast<const __m256i*>(row + i - 1);
      const auto* const above = reinterpret_cast<const __m256i*>(row + i - kRow);
      const __m256i pixels = _mm256_loadu_si256(here);
      const __m256i same = _mm256_cmpeq_epi8(pixels, _mm256_loadu_si256(before));
      facts->begins[i / 32] = ~static_cast<std::uint32_t>(_mm256_movemask_epi8(same));
      differences = _mm256_or_si256(differences, _mm256_xor_si256(pixels, _mm256_loadu_si256(above)));
    }
    facts->repeats = static_cast<std::uint32_t>(_mm256_testz_si256(differences, differences));
  }
}

// Nibbles are looked up, then the digits of both nibbles are interleaved. AVX2 does that in each 128 bits
// separately, so the four groups of eight bytes are first brought into the order 0 2 1 3.
[[gnu::target("avx2")]] void write_hex_avx2(char* to, const std::uint8_t* bytes, std::size_t count) {
  const __m256i digits = _mm256_broadcastsi128_si256(
      _mm_setr_epi8('0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'A', 'B', 'C', 'D', 'E', 'F'));
  const __m256i low_half = _mm256_set1_epi8(0x0F);
  std::size_t i = 0;
  for (; i + 32 <= count; i += 32) {
    __m256i both = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes + i));
    both = _mm256_permute4x64_epi64(both, 0b11'01'10'00);
    const __m256i high = _mm256_shuffle_epi8(digits, _mm256_and_si256(_mm256_srli_epi16(both, 4), low_half));
    const __m256i low = _mm256_shuffle_epi8(digits, _mm256_and_si256(both, low_half));
    const auto place = reinterpret_cast<__m256i*>(to + 2 * i);
    _mm256_storeu_si256(place, _mm256_unpacklo_epi8(high, low));
    _mm256_storeu_si256(place + 1, _mm256_unpackhi_epi8(high, low));
  }
  write_hex_plain(to + 2 * i, bytes + i, count - i);
}

}  // namespace racebeam

#endif

// Bytes as hexadecimal digits: with AVX2 32 at a time, elsewhere by a table.
#include <cstring>

#include "protocol/encoding/hex_pairs.hpp"
#include "protocol/encoding/text.hpp"

#if RACEBEAM_HAS_AVX
#include <immintrin.h>
#endif

namespace racebeam {
namespace {

void write_plain(char* to, const std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + 2 * i, &kHexPairs[bytes[i]], 2);
}

#if RACEBEAM_HAS_AVX
// Nibbles are looked up, then the digits of both nibbles are interleaved. AVX2 does that in each 128 bits
// separately, so the four groups of eight bytes are first brought into the order 0 2 1 3.
[[gnu::target("avx2")]] void write_avx2(char* to, const std::uint8_t* bytes, std::size_t count) {
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
  write_plain(to + 2 * i, bytes + i, count - i);
}
#endif

}  // namespace

void append_hex(std::string& out, std::span<const std::uint8_t> bytes, [[maybe_unused]] Simd form) {
  const std::size_t start = out.size();
  out.resize(start + 2 * bytes.size());
  char* const to = out.data() + start;
#if RACEBEAM_HAS_AVX
  if (form >= Simd::kAvx2) return write_avx2(to, bytes.data(), bytes.size());
#endif
  write_plain(to, bytes.data(), bytes.size());
}

}  // namespace racebeam

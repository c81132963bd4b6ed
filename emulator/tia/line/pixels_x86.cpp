// Pixels with AVX2 and with AVX-512.
#include <immintrin.h>

#include "emulator/tia/line/pixel_layers.hpp"

#if RACEBEAM_HAS_AVX

#define RACEBEAM_AVX2 [[gnu::target("avx2")]]
#define RACEBEAM_AVX512 [[gnu::target("avx512f,avx512bw")]]

namespace racebeam {
namespace {

// 32 pixels, as bytes of ones where they are covered.
RACEBEAM_AVX2 inline __m256i bytes_of(std::uint32_t covered) {
  const __m256i byte_of_each =
      _mm256_setr_epi64x(0, 0x0101010101010101, 0x0202020202020202, 0x0303030303030303);
  const __m256i bit_of_each = _mm256_set1_epi64x(static_cast<long long>(0x8040201008040201));
  const __m256i spread = _mm256_shuffle_epi8(_mm256_set1_epi32(static_cast<int>(covered)), byte_of_each);
  return _mm256_cmpeq_epi8(_mm256_and_si256(spread, bit_of_each), bit_of_each);
}

RACEBEAM_AVX2 inline __m256i painted_avx2(__m256i pixels, std::uint32_t covered, std::uint8_t ink) {
  return _mm256_blendv_epi8(pixels, _mm256_set1_epi8(static_cast<char>(ink)), bytes_of(covered));
}

RACEBEAM_AVX512 inline __m512i painted_avx512(__m512i pixels, std::uint64_t covered, std::uint8_t ink) {
  return _mm512_mask_set1_epi8(pixels, covered, static_cast<char>(ink));
}

}  // namespace

RACEBEAM_AVX2 void draw_avx2(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                             int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const LayerOrder order = order_of(tia);
  for (auto word = static_cast<std::size_t>(first) / 64; 64 * word < static_cast<std::size_t>(last); ++word) {
    auto [colupf, colup1, colup0] = layers_at(line, order, word);
    std::uint64_t shown = inside.word[word];
    for (std::uint8_t* at = row + 64 * word; shown != 0; at += 32) {
      if (const auto bits = static_cast<std::uint32_t>(shown); bits != 0) {
        __m256i pixels = _mm256_set1_epi8(static_cast<char>(tia.color[kColubk]));
        if (static_cast<std::uint32_t>(colupf | colup1 | colup0) != 0) {  // else only the background is seen
          pixels = painted_avx2(pixels, static_cast<std::uint32_t>(colupf), tia.color[kColupf]);
          pixels = painted_avx2(pixels, static_cast<std::uint32_t>(colup1), tia.color[kColup1]);
          pixels = painted_avx2(pixels, static_cast<std::uint32_t>(colup0), tia.color[kColup0]);
        }
        auto* const place = reinterpret_cast<__m256i*>(at);
        if (bits != ~std::uint32_t{0})
          pixels = _mm256_blendv_epi8(_mm256_load_si256(place), pixels, bytes_of(bits));
        _mm256_store_si256(place, pixels);
      }
      shown >>= 32, colupf >>= 32, colup1 >>= 32, colup0 >>= 32;
    }
  }
}

RACEBEAM_AVX512 void draw_avx512(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                                 int last) {
  const LayerOrder order = order_of(tia);
  std::uint64_t inside = ~std::uint64_t{0} << (first % 64);
  for (int at = first & ~63; at < last; at += 64, inside = ~std::uint64_t{0}) {
    if (last - at < 64) inside &= (std::uint64_t{1} << (last - at)) - 1;
    const auto [colupf, colup1, colup0] = layers_at(line, order, static_cast<std::size_t>(at) / 64);
    __m512i pixels = _mm512_set1_epi8(static_cast<char>(tia.color[kColubk]));
    pixels = painted_avx512(pixels, colupf, tia.color[kColupf]);
    pixels = painted_avx512(pixels, colup1, tia.color[kColup1]);
    pixels = painted_avx512(pixels, colup0, tia.color[kColup0]);
    _mm512_mask_storeu_epi8(row + at, inside, pixels);
  }
}

}  // namespace racebeam

#endif

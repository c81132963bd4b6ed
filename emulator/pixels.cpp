#include "emulator/pixels.hpp"

#include <bit>
#include <cstring>

#if RACEBEAM_HAS_AVX
#include <immintrin.h>
#endif

namespace racebeam {
namespace {

// Each bit of a byte as a byte of ones, bit 0 in the lowest.
constexpr std::array<std::uint64_t, 256> make_spread() {
  std::array<std::uint64_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i)
    for (unsigned b = 0; b < 8; ++b)
      if (i >> b & 1) table[i] |= std::uint64_t{0xFF} << (8 * b);
  return table;
}
constexpr auto kSpread = make_spread();
constexpr std::uint64_t kOnes = 0x0101010101010101;

// Where eight pixels are covered, the ink replaces what is there.
std::uint64_t painted(std::uint64_t pixels, std::uint8_t covered, std::uint64_t ink) {
  return pixels ^ ((pixels ^ ink) & kSpread[covered]);
}

// Most masks cover few groups of eight pixels.
void paint(std::uint8_t* row, const PixelMask& mask, std::uint64_t ink) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::uint64_t rest = mask.word[i]; rest != 0;) {
      const int group = std::countr_zero(rest) / 8;
      std::uint8_t* at = row + 64 * i + 8 * group;
      std::uint64_t pixels;
      std::memcpy(&pixels, at, sizeof pixels);
      pixels = painted(pixels, static_cast<std::uint8_t>(rest >> (8 * group)), ink);
      std::memcpy(at, &pixels, sizeof pixels);
      rest &= ~(std::uint64_t{0xFF} << (8 * group));
    }
  }
}

constexpr int kNarrow = 32;

// Background first, then the groups of eight that a layer covers.
void draw_wide(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  std::memset(row + first, tia.color[kColubk], static_cast<std::size_t>(last - first));
  if (line.layers == 0) return;
  const PixelMask inside = PixelMask::range(first, last);
  for (const Layer& layer : line.shown_layers()) paint(row, layer.mask & inside, tia.color[layer.color] * kOnes);
}

// Group by group, all layers at once.
void draw_narrow(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const std::uint64_t background = tia.color[kColubk] * kOnes;
  for (auto group = static_cast<std::size_t>(first) / 8; group <= static_cast<std::size_t>(last - 1) / 8; ++group) {
    std::uint64_t pixels = background, old;
    for (const Layer& layer : line.shown_layers())
      pixels = painted(pixels, layer.mask.byte(group), tia.color[layer.color] * kOnes);
    std::memcpy(&old, row + 8 * group, sizeof old);
    pixels = painted(old, inside.byte(group), pixels);
    std::memcpy(row + 8 * group, &pixels, sizeof pixels);
  }
}

void draw_plain(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  if (last - first > kNarrow) draw_wide(line, tia, row, first, last);
  else draw_narrow(line, tia, row, first, last);
}

#if RACEBEAM_HAS_AVX

// 32 pixels of a mask, as bytes of ones.
[[gnu::target("avx2")]] inline __m256i bytes_of(const PixelMask& mask, int group) {
  std::uint32_t bits;
  std::memcpy(&bits, reinterpret_cast<const char*>(mask.word.data()) + 4 * group, sizeof bits);
  const __m256i byte_of_each = _mm256_setr_epi64x(0, 0x0101010101010101, 0x0202020202020202, 0x0303030303030303);
  const __m256i bit_of_each = _mm256_set1_epi64x(static_cast<long long>(0x8040201008040201));
  const __m256i spread = _mm256_shuffle_epi8(_mm256_set1_epi32(static_cast<int>(bits)), byte_of_each);
  return _mm256_cmpeq_epi8(_mm256_and_si256(spread, bit_of_each), bit_of_each);
}

[[gnu::target("avx2")]] void draw_avx2(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  const auto ink = [&tia](unsigned color) { return static_cast<char>(tia.color[color]); };
  const __m256i background = _mm256_set1_epi8(ink(kColubk));
  const PixelMask inside = PixelMask::range(first, last);
  for (int group = first / 32; 32 * group < last; ++group) {
    auto* const at = reinterpret_cast<__m256i*>(row + 32 * group);
    __m256i pixels = background;
    for (const Layer& layer : line.shown_layers())
      pixels = _mm256_blendv_epi8(pixels, _mm256_set1_epi8(ink(layer.color)), bytes_of(layer.mask, group));
    if (32 * group < first || 32 * group + 32 > last)
      pixels = _mm256_blendv_epi8(_mm256_load_si256(at), pixels, bytes_of(inside, group));
    _mm256_store_si256(at, pixels);
  }
}

[[gnu::target("avx512f,avx512bw")]] void draw_avx512(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                                                     int last) {
  const auto ink = [&tia](unsigned color) { return static_cast<char>(tia.color[color]); };
  const PixelMask inside = PixelMask::range(first, last);
  for (auto word = static_cast<std::size_t>(first) / 64; 64 * word < static_cast<std::size_t>(last); ++word) {
    __m512i pixels = _mm512_set1_epi8(ink(kColubk));
    for (const Layer& layer : line.shown_layers())
      pixels = _mm512_mask_blend_epi8(layer.mask.word[word], pixels, _mm512_set1_epi8(ink(layer.color)));
    _mm512_mask_storeu_epi8(row + 64 * word, inside.word[word], pixels);
  }
}

#endif

}  // namespace

DrawPixels pixel_drawer(Simd simd) {
#if RACEBEAM_HAS_AVX
  if (simd == Simd::kAvx512) return draw_avx512;
  if (simd == Simd::kAvx2) return draw_avx2;
#endif
  static_cast<void>(simd);
  return draw_plain;
}

}  // namespace racebeam

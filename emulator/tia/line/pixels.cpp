#include "emulator/tia/line/pixels.hpp"

#include <bit>
#include <cstring>

#include "emulator/base/inlining.hpp"

#if RACEBEAM_HAS_AVX
#include <immintrin.h>
#endif

namespace racebeam {
namespace {

constexpr std::uint8_t kScoreMode = 2, kPriorityMode = 4;  // bits of CTRLPF

constexpr PixelMask kLeftHalf = {{~std::uint64_t{0}, 0xFFFF, 0}};
constexpr PixelMask kRightHalf = {{0, ~std::uint64_t{0xFFFF}, 0xFFFFFFFF}};

// Which object hides which (docs/spec/tia.md, 10). In score mode, each half of the playfield has its player's
// colour, unless the playfield has priority.
enum class Order { kPlayersInFront, kPlayfieldInFront, kScore };

RACEBEAM_INLINE Order order_of(const TiaRegisters& tia) {
  const bool in_front = (tia.ctrlpf & kPriorityMode) != 0;
  if ((tia.ctrlpf & kScoreMode) != 0 && (!in_front || tia.enabled == object_bit(kPlayfield)))
    return Order::kScore;
  return in_front ? Order::kPlayfieldInFront : Order::kPlayersInFront;
}

// Three layers of 64 pixels, from back to front: a later one hides an earlier one.
struct Layers {
  std::uint64_t colupf, colup1, colup0;
};

RACEBEAM_INLINE Layers layers_at(const Line& line, Order order, std::size_t word) {
  const auto object = [&](Object which) { return line.mask[which].word[word]; };
  const std::uint64_t player0 = object(kP0) | object(kM0), player1 = object(kP1) | object(kM1);
  const std::uint64_t playfield = object(kPlayfield), ball = object(kBall);
  switch (order) {
    case Order::kScore:
      return {ball, player1 | (playfield & kRightHalf.word[word]),
              player0 | (playfield & kLeftHalf.word[word])};
    case Order::kPlayfieldInFront:
      return {playfield | ball, player1 & ~(playfield | ball), player0 & ~(playfield | ball)};
    default: return {playfield | ball, player1, player0};
  }
}

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

// Replaces the covered ones of eight pixels by the ink.
std::uint64_t painted(std::uint64_t pixels, std::uint8_t covered, std::uint64_t ink) {
  return pixels ^ ((pixels ^ ink) & kSpread[covered]);
}

// Most masks cover few groups of eight pixels.
void paint(std::uint8_t* row, std::uint64_t covered, std::uint64_t ink) {
  for (std::uint64_t rest = covered; rest != 0;) {
    const int group = std::countr_zero(rest) / 8;
    std::uint64_t pixels;
    std::memcpy(&pixels, row + 8 * group, sizeof pixels);
    pixels = painted(pixels, static_cast<std::uint8_t>(rest >> (8 * group)), ink);
    std::memcpy(row + 8 * group, &pixels, sizeof pixels);
    rest &= ~(std::uint64_t{0xFF} << (8 * group));
  }
}

constexpr int kNarrow = 32;

// Draws the background, then the groups of eight that a layer covers.
void draw_wide(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  std::memset(row + first, tia.color[kColubk], static_cast<std::size_t>(last - first));
  if (line.covered == 0) return;
  const PixelMask inside = PixelMask::range(first, last);
  const Order order = order_of(tia);
  for (std::size_t word = 0; word < inside.word.size(); ++word, row += 64) {
    const Layers layers = layers_at(line, order, word);
    paint(row, layers.colupf & inside.word[word], tia.color[kColupf] * kOnes);
    paint(row, layers.colup1 & inside.word[word], tia.color[kColup1] * kOnes);
    paint(row, layers.colup0 & inside.word[word], tia.color[kColup0] * kOnes);
  }
}

// Draws group by group, all layers at once.
void draw_narrow(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const Order order = order_of(tia);
  for (auto group = static_cast<std::size_t>(first) / 8; group <= static_cast<std::size_t>(last - 1) / 8;
       ++group) {
    const auto [colupf, colup1, colup0] = layers_at(line, order, group / 8);
    const auto bits = [group](std::uint64_t word) {
      return static_cast<std::uint8_t>(word >> (8 * (group % 8)));
    };
    std::uint64_t pixels = tia.color[kColubk] * kOnes, old;
    pixels = painted(pixels, bits(colupf), tia.color[kColupf] * kOnes);
    pixels = painted(pixels, bits(colup1), tia.color[kColup1] * kOnes);
    pixels = painted(pixels, bits(colup0), tia.color[kColup0] * kOnes);
    std::memcpy(&old, row + 8 * group, sizeof old);
    pixels = painted(old, inside.byte(group), pixels);
    std::memcpy(row + 8 * group, &pixels, sizeof pixels);
  }
}

void draw_plain(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  if (last - first > kNarrow)
    draw_wide(line, tia, row, first, last);
  else
    draw_narrow(line, tia, row, first, last);
}

#if RACEBEAM_HAS_AVX

#define RACEBEAM_AVX2 [[gnu::target("avx2")]]
#define RACEBEAM_AVX512 [[gnu::target("avx512f,avx512bw")]]

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

RACEBEAM_AVX2 void draw_avx2(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                             int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const Order order = order_of(tia);
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

RACEBEAM_AVX512 inline __m512i painted_avx512(__m512i pixels, std::uint64_t covered, std::uint8_t ink) {
  return _mm512_mask_set1_epi8(pixels, covered, static_cast<char>(ink));
}

RACEBEAM_AVX512 void draw_avx512(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                                 int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const Order order = order_of(tia);
  for (auto word = static_cast<std::size_t>(first) / 64; 64 * word < static_cast<std::size_t>(last); ++word) {
    const auto [colupf, colup1, colup0] = layers_at(line, order, word);
    __m512i pixels = _mm512_set1_epi8(static_cast<char>(tia.color[kColubk]));
    pixels = painted_avx512(pixels, colupf, tia.color[kColupf]);
    pixels = painted_avx512(pixels, colup1, tia.color[kColup1]);
    pixels = painted_avx512(pixels, colup0, tia.color[kColup0]);
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

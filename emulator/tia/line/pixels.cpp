#include "emulator/tia/line/pixels.hpp"

#include <bit>
#include <cstring>

#include "emulator/tia/line/pixel_layers.hpp"

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

// Replaces the covered ones of eight pixels by the ink.
std::uint64_t painted(std::uint64_t pixels, std::uint8_t covered, std::uint64_t ink) {
  return pixels ^ ((pixels ^ ink) & kSpread[covered]);
}

// Most masks cover few groups of eight pixels.
void paint(std::uint8_t* row, std::uint64_t covered, std::uint8_t color) {
  const std::uint64_t ink = color * kOnes;
  for (std::uint64_t rest = covered; rest != 0;) {
    const int group = std::countr_zero(rest) / 8;
    std::uint64_t pixels;
    std::memcpy(&pixels, row + 8 * group, sizeof pixels);
    pixels = painted(pixels, static_cast<std::uint8_t>(rest >> (8 * group)), ink);
    std::memcpy(row + 8 * group, &pixels, sizeof pixels);
    rest &= ~(std::uint64_t{0xFF} << (8 * group));
  }
}

constexpr int kNarrow = 32;  // pixels

// Draws group by group, all layers at once.
void draw_narrow(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last) {
  const PixelMask inside = PixelMask::range(first, last);
  const LayerOrder order = order_of(tia);
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
    draw_layers(line, tia, row, first, last, paint);
  else
    draw_narrow(line, tia, row, first, last);
}

}  // namespace

DrawPixels pixel_drawer([[maybe_unused]] Simd simd) {
  if constexpr (kHasAvx) {
    if (simd == Simd::kAvx512) return draw_avx512;
    if (simd == Simd::kAvx2) return draw_avx2;
  }
  if constexpr (kHasNeon) {
    if (simd == Simd::kNeon) return draw_neon;
  }
  return draw_plain;
}

}  // namespace racebeam

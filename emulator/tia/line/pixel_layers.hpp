// The layers of a line that every form of drawing pixels paints, and the forms for single processors.
#pragma once

#include <cstdint>
#include <cstring>

#include "emulator/base/inlining.hpp"
#include "emulator/tia/line/pixels.hpp"

namespace racebeam {

inline constexpr std::uint8_t kScoreMode = 2, kPriorityMode = 4;  // bits of CTRLPF

inline constexpr PixelMask kLeftHalf = {{~std::uint64_t{0}, 0xFFFF, 0}};
inline constexpr PixelMask kRightHalf = {{0, ~std::uint64_t{0xFFFF}, 0xFFFFFFFF}};

// Which object hides which (docs/spec/tia.md, 10). In score mode, each half of the playfield has its player's
// colour, unless the playfield has priority.
enum class LayerOrder { kPlayersInFront, kPlayfieldInFront, kScore };

RACEBEAM_INLINE LayerOrder order_of(const TiaRegisters& tia) {
  const bool in_front = (tia.ctrlpf & kPriorityMode) != 0;
  if ((tia.ctrlpf & kScoreMode) != 0 && (!in_front || tia.enabled == object_bit(kPlayfield)))
    return LayerOrder::kScore;
  return in_front ? LayerOrder::kPlayfieldInFront : LayerOrder::kPlayersInFront;
}

// Three layers of 64 pixels, from back to front: a later one hides an earlier one.
struct Layers {
  std::uint64_t colupf, colup1, colup0;
};

RACEBEAM_INLINE Layers layers_at(const Line& line, LayerOrder order, std::size_t word) {
  const auto object = [&](Object which) { return line.mask[which].word[word]; };
  const std::uint64_t player0 = object(kP0) | object(kM0), player1 = object(kP1) | object(kM1);
  const std::uint64_t playfield = object(kPlayfield), ball = object(kBall);
  switch (order) {
    case LayerOrder::kScore:
      return {ball, player1 | (playfield & kRightHalf.word[word]),
              player0 | (playfield & kLeftHalf.word[word])};
    case LayerOrder::kPlayfieldInFront:
      return {playfield | ball, player1 & ~(playfield | ball), player0 & ~(playfield | ball)};
    default: return {playfield | ball, player1, player0};
  }
}

// Draws the background, then calls paint(row, covered, color) for each layer of each 64 pixels, from back to
// front. `covered` may be 0.
template <typename Paint>
RACEBEAM_INLINE void draw_layers(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first,
                                 int last, Paint paint) {
  std::memset(row + first, tia.color[kColubk], static_cast<std::size_t>(last - first));
  if (tia.enabled == 0) return;
  const PixelMask inside = PixelMask::range(first, last);
  const LayerOrder order = order_of(tia);
  for (auto word = static_cast<std::size_t>(first) / 64; 64 * word < static_cast<std::size_t>(last); ++word) {
    const Layers layers = layers_at(line, order, word);
    paint(row + 64 * word, layers.colupf & inside.word[word], tia.color[kColupf]);
    paint(row + 64 * word, layers.colup1 & inside.word[word], tia.color[kColup1]);
    paint(row + 64 * word, layers.colup0 & inside.word[word], tia.color[kColup0]);
  }
}

// Forms of DrawPixels: pixels_x86.cpp, pixels_neon.cpp.
void draw_avx2(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last);
void draw_avx512(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last);
void draw_neon(const Line& line, const TiaRegisters& tia, std::uint8_t* row, int first, int last);

}  // namespace racebeam

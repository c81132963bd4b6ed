// The screen as the feature sets see it: 210 rows of 160 colours.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "environment/environment.hpp"

namespace racebeam {

constexpr int kFeatureWidth = kScreenWidth, kFeatureHeight = 210;
constexpr std::size_t kFeaturePixels = std::size_t{kFeatureWidth} * kFeatureHeight;
constexpr int kColours = 128;

// The colour of a palette index, from 0 to 127. The lowest bit of an index means nothing.
constexpr std::uint8_t colour_of(std::uint8_t index) { return index >> 1; }

// SECAM's colour of a colour, from 0 to 7: only the brightness.
constexpr std::uint8_t secam_of(std::uint8_t colour) { return colour & 7; }

using Screen = std::span<const std::uint8_t, kFeaturePixels>;  // palette indices, row by row

// Rows beyond the 210th are left out, and rows that are missing are black.
class FeatureScreen {
 public:
  Screen of(const Environment& environment) {
    const std::span<const std::uint8_t> screen = environment.screen();
    if (screen.size() >= kFeaturePixels) return screen.first<kFeaturePixels>();
    padded_.fill(0);
    std::copy(screen.begin(), screen.end(), padded_.begin());
    return padded_;
  }

 private:
  std::array<std::uint8_t, kFeaturePixels> padded_;
};

}  // namespace racebeam

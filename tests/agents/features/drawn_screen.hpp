// Screens that tests draw.
#pragma once

#include <initializer_list>
#include <string_view>

#include "agents/features/screen.hpp"
#include "agents/features/shape.hpp"

namespace racebeam::test {

using Pattern = std::initializer_list<std::string_view>;  // rows; a blank leaves the pixel as it is

struct DrawnScreen {
  std::array<std::uint8_t, kFeaturePixels> pixels{};

  DrawnScreen& put(int x, int y, int colour) {
    pixels[static_cast<std::size_t>(y * kFeatureWidth + x)] = static_cast<std::uint8_t>(colour << 1);
    return *this;
  }
  DrawnScreen& draw(int left, int top, Pattern pattern, int colour = 9) {
    for (int y = top; const std::string_view row : pattern) {
      for (int x = left; const char pixel : row) {
        if (pixel != ' ') put(x, y, colour);
        ++x;
      }
      ++y;
    }
    return *this;
  }
};

inline Shape shape_of(Pattern pattern) {
  Shape shape;
  for (std::uint8_t y = 0; const std::string_view row : pattern) {
    for (std::size_t x = 0; x < row.size(); ++x) {
      if (row[x] == ' ') continue;
      if (x > 0 && row[x - 1] != ' ')
        ++shape.back().last;
      else
        shape.push_back({y, static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(x)});
    }
    ++y;
  }
  return shape;
}

}  // namespace racebeam::test

// The shape of an object: its pixels, wherever it is on the screen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace racebeam {

// Pixels `first` to `last` of a row. Runs of a shape are in the order of rows, then of columns, and do not
// touch.
struct PixelRun {
  std::uint8_t row, first, last;
  bool operator==(const PixelRun&) const = default;
};

// The smallest rectangle around pixels.
struct Box {
  int left, top, width, height;
  int x() const { return left + width / 2; }  // the centre
  int y() const { return top + height / 2; }
};

// Counted from the upper left corner of the shape's box.
using Shape = std::vector<PixelRun>;
using ShapeView = std::span<const PixelRun>;

// A hash of a shape. Of a million different shapes, no two have the same key with a probability of 1 - 10^-7.
using ShapeKey = std::uint64_t;
ShapeKey key_of(ShapeView shape);

int area_of(ShapeView shape);  // pixels
Box box_of(ShapeView shape);

// The shape itself, and mirrored left to right, top to bottom, and both.
constexpr int kMirrors = 4;
Shape mirrored(ShapeView shape, int mirror);

// Returns the number of pixels that only one of two shapes has when their centres coincide.
int difference(ShapeView a, ShapeView b);

}  // namespace racebeam

#include "agents/features/shape.hpp"

#include <algorithm>

namespace racebeam {

ShapeKey key_of(ShapeView shape) {
  ShapeKey key = 0;
  for (const PixelRun& run : shape) {
    key ^= static_cast<ShapeKey>(run.row) << 16 | static_cast<ShapeKey>(run.first) << 8 | run.last;
    key *= 0x9E3779B97F4A7C15;
    key ^= key >> 29;
  }
  return key;
}

int area_of(ShapeView shape) {
  int area = 0;
  for (const PixelRun& run : shape) area += run.last - run.first + 1;
  return area;
}

Box box_of(ShapeView shape) {
  int left = 255, right = 0;
  for (const PixelRun& run : shape) {
    left = std::min<int>(left, run.first);
    right = std::max<int>(right, run.last);
  }
  const int top = shape.front().row;
  return {left, top, right - left + 1, shape.back().row - top + 1};
}

Shape mirrored(ShapeView shape, int mirror) {
  const Box box = box_of(shape);
  const int right = box.width - 1, bottom = box.height - 1;
  const bool sideways = (mirror & 1) != 0, upside_down = (mirror & 2) != 0;
  Shape result;
  for (const PixelRun& run : shape) {
    const int row = upside_down ? bottom - run.row : run.row;
    const int first = sideways ? right - run.last : run.first, last = sideways ? right - run.first : run.last;
    result.push_back(
        {static_cast<std::uint8_t>(row), static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last)});
  }
  std::ranges::sort(result, [](const PixelRun& a, const PixelRun& b) {
    return a.row != b.row ? a.row < b.row : a.first < b.first;
  });
  return result;
}

int difference(ShapeView a, ShapeView b) {
  const Box box_a = box_of(a), box_b = box_of(b);
  const int right = box_a.width / 2 - box_b.width / 2, down = box_a.height / 2 - box_b.height / 2;
  int both = 0;
  auto row = b.begin();  // the first run of b that is not above a's
  for (const PixelRun& run : a) {
    while (row != b.end() && row->row + down < run.row) ++row;
    for (auto other = row; other != b.end() && other->row + down == run.row; ++other)
      both += std::max(0, std::min<int>(run.last, other->last + right) -
                              std::max<int>(run.first, other->first + right) + 1);
  }
  return area_of(a) + area_of(b) - 2 * both;
}

}  // namespace racebeam

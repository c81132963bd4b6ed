#include "environment/observe/enlarge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace racebeam {
namespace {

constexpr float kOne = 2048;  // the weight of a whole cell

std::size_t checked(int width, int height, int to_width, int to_height) {
  if (width > 0 && height > 0 && to_width > 0 && to_height > 0 &&
      to_width <= static_cast<int>(Enlargement::kWidest)) {
    return static_cast<std::size_t>(width);
  }
  throw std::invalid_argument("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                              " can't be enlarged to " + std::to_string(to_width) + " x " +
                              std::to_string(to_height) + "; the width can be at most " +
                              std::to_string(Enlargement::kWidest));
}

}  // namespace

LinearAxis::LinearAxis(int cells, int count) {
  const double growth = static_cast<double>(count) / cells, scale = 1.0 / growth;
  for (int target = 0; target < count; ++target) {
    int first = static_cast<int>(std::floor(target * scale));
    float share = static_cast<float>((target + 1) - (first + 1) * growth);  // of the second cell
    share = share <= 0 ? 0.0F : share - std::floor(share);
    if (first >= cells - 1) first = cells - 1, share = 0;
    targets.push_back({static_cast<std::size_t>(first),
                       static_cast<std::size_t>(std::min(first + 1, cells - 1)),
                       static_cast<std::int32_t>(std::lrint((1.0F - share) * kOne)),
                       static_cast<std::int32_t>(std::lrint(share * kOne))});
  }
}

Enlargement::Enlargement(int width, int height, int to_width, int to_height)
    : width_(checked(width, height, to_width, to_height)),
      columns_(width, to_width),
      rows_(height, to_height) {}

// Source rows are widened once each. They are kept with 7 bits behind the point, as OpenCV adds them.
void Enlargement::operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) const {
  std::array<std::array<std::int32_t, kWidest>, 2> memory;
  std::int32_t *above = memory[0].data(), *below = memory[1].data();
  std::size_t row_above = SIZE_MAX, row_below = SIZE_MAX;
  const auto widen = [&](std::size_t row, std::int32_t* to) {
    const std::uint8_t* const cells = in.data() + row * width_;
    for (const auto& [first, second, weight, opposite] : columns_.targets)
      *to++ = (cells[first] * weight + cells[second] * opposite) >> 4;
  };
  std::uint8_t* to = out.data();
  const std::size_t count = columns_.targets.size();
  for (const auto& [first, second, weight, opposite] : rows_.targets) {
    if (first == row_below) std::swap(above, below), std::swap(row_above, row_below);
    if (first != row_above) widen(row_above = first, above);
    if (second != row_below) widen(row_below = second, below);
    for (std::size_t x = 0; x < count; ++x)
      *to++ = static_cast<std::uint8_t>(((above[x] * weight >> 16) + (below[x] * opposite >> 16) + 2) >> 2);
  }
}

}  // namespace racebeam

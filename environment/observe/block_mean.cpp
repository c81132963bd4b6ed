#include "environment/observe/block_mean.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace racebeam {
namespace {

void check(int width, int height, int to_width, int to_height) {
  if (BlockMean::fits(width, height, to_width, to_height) && width <= static_cast<int>(BlockMean::kWidest))
    return;
  throw std::invalid_argument("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                              " has no whole blocks for one of " + std::to_string(to_width) + " x " +
                              std::to_string(to_height) + ", or is wider than " +
                              std::to_string(BlockMean::kWidest));
}

}  // namespace

bool BlockMean::fits(int width, int height, int to_width, int to_height) {
  return width > 0 && height > 0 && to_width > 0 && to_height > 0 && width % to_width == 0 &&
         height % to_height == 0;
}

BlockMean::BlockMean(int width, int height, int to_width, int to_height)
    : width_((check(width, height, to_width, to_height), static_cast<std::size_t>(width))),
      to_width_(static_cast<std::size_t>(to_width)),
      to_height_(static_cast<std::size_t>(to_height)),
      across_(static_cast<std::size_t>(width / to_width)),
      down_(static_cast<std::size_t>(height / to_height)),
      share_(static_cast<float>(1.0 / static_cast<double>(across_ * down_))) {}

// Halves go up in blocks of 2 x 2, and to the even number in others.
std::uint8_t BlockMean::mean(std::uint32_t sum) const {
  if (across_ == 2 && down_ == 2) return static_cast<std::uint8_t>((sum + 2) / 4);
  return static_cast<std::uint8_t>(std::lrint(static_cast<float>(sum) * share_));
}

void BlockMean::operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out,
                           std::span<const std::uint8_t> rows) const {
  std::array<std::uint32_t, kWidest> sums;
  for (std::size_t y = 0; y < to_height_; ++y) {
    if (!rows.empty() && rows[y] == 0) continue;
    const auto block_row = in.subspan(y * down_ * width_, down_ * width_);
    std::fill_n(sums.begin(), width_, 0U);
    for (std::size_t row = 0; row < block_row.size(); row += width_)
      for (std::size_t x = 0; x < width_; ++x) sums[x] += block_row[row + x];
    const std::uint32_t* cells = sums.data();
    for (std::uint8_t& target : out.subspan(y * to_width_, to_width_)) {
      target = mean(std::accumulate(cells, cells + across_, 0U));
      cells += across_;
    }
  }
}

void BlockMean::depending(std::span<const std::uint8_t> changed, std::span<std::uint8_t> rows) const {
  for (std::size_t y = 0; y < to_height_; ++y) {
    const auto sources = changed.subspan(y * down_, down_);
    rows[y] = std::ranges::any_of(sources, [](std::uint8_t flag) { return flag != 0; }) ? 1 : 0;
  }
}

}  // namespace racebeam

// Tile coding of a place in a plane (Sutton and Barto 1998, section 8.3.2): several grids, each shifted by a
// part of a tile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace racebeam {

class TileCoding {
 public:
  // Places from (0, 0) to (width - 1, height - 1). `grid` tiles are as long as a side. Tiling t of n is
  // shifted by t / n of a tile to the left and upwards, so that it has a tile more in each direction.
  TileCoding(int width, int height, int tilings, int grid)
      : tilings_(static_cast<std::uint32_t>(tilings)), side_(static_cast<std::uint32_t>(grid) + 1) {
    for (int tiling = 0; tiling < tilings; ++tiling) {
      add_axis(columns_, width, tilings, grid, tiling);
      add_axis(rows_, height, tilings, grid, tiling);
    }
    width_ = static_cast<std::uint32_t>(width);
    height_ = static_cast<std::uint32_t>(height);
  }

  std::uint32_t tilings() const { return tilings_; }
  std::uint32_t tiles() const { return side_ * side_; }  // of a tiling
  std::uint32_t size() const { return tilings_ * tiles(); }

  // The tile of a place in a tiling, among those of all tilings.
  std::uint32_t tile(std::uint32_t tiling, int x, int y) const {
    const std::uint32_t column = columns_[tiling * width_ + static_cast<std::uint32_t>(x)];
    const std::uint32_t row = rows_[tiling * height_ + static_cast<std::uint32_t>(y)];
    return (tiling * side_ + row) * side_ + column;
  }

 private:
  static void add_axis(std::vector<std::uint8_t>& out, int length, int tilings, int grid, int tiling) {
    for (int at = 0; at < length; ++at)
      out.push_back(static_cast<std::uint8_t>((at * grid * tilings + tiling * length) / (length * tilings)));
  }

  std::uint32_t tilings_, side_;
  std::uint32_t width_, height_;
  std::vector<std::uint8_t> columns_, rows_;  // per tiling and coordinate
};

}  // namespace racebeam

// A screen of the machine, and the place that a terminal has for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "system/program/tty.hpp"

namespace racebeam {

constexpr std::size_t kPixelsARow = 160;

struct TerminalPicture {
  std::vector<std::uint8_t> pixels;   // rows of kPixelsARow, as the line protocol's field screen
  std::vector<std::uint8_t> colours;  // 256 x 3: red, green, blue of each value of a pixel

  std::size_t height() const { return pixels.size() / kPixelsARow; }
  std::span<const std::uint8_t, 3> colour(std::size_t value) const {
    return std::span<const std::uint8_t>(colours).subspan(3 * value).first<3>();
  }
};

// The part of the terminal that a picture may take.
using Room = TerminalSize;
constexpr std::size_t kScrollingRows = 10'000;  // where text scrolls: no limit

}  // namespace racebeam

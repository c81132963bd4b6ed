// Screens as PNG: 8-bit palette, no filter, every pixel doubled.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "recording/media.hpp"

namespace racebeam {

class PngWriter {
 public:
  explicit PngWriter(const Footage& footage);

  // The file of a screen: height x 160 palette indices. It lasts until the next call.
  std::span<const std::uint8_t> file(std::span<const std::uint8_t> pixels);

 private:
  std::vector<std::uint8_t> head_, rows_, packed_, file_;
};

}  // namespace racebeam

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

  // Returns the bytes of a screen's file. `pixels`: height x 160 palette indices. The result is valid until
  // the next call.
  std::span<const std::uint8_t> file(std::span<const std::uint8_t> pixels);

 private:
  std::vector<std::uint8_t> head_, rows_, packed_, file_;
};

}  // namespace racebeam

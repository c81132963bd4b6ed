// Resizes planes of bytes that grow in width or height, as OpenCV's INTER_AREA does, to the byte.
//
// OpenCV then interpolates linearly, with weights of 11 bits. A target lies between two source cells, or
// within one. An axis that shrinks is treated the same way, so that cells between the two are skipped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace racebeam {

// One axis: each target is a weighted sum of two source cells.
struct LinearAxis {
  struct Target {
    std::size_t first, second;      // source cells
    std::int32_t weight, opposite;  // of the first and of the second; their sum is 2048
  };

  LinearAxis(int cells, int targets);

  std::vector<Target> targets;
};

// Enlarges planes of bytes, in row-major order. Thread-safe after construction.
class Enlargement {
 public:
  static constexpr std::size_t kWidest = 512;

  // Throws std::invalid_argument if a size is not positive, or if to_width is above kWidest.
  Enlargement(int width, int height, int to_width, int to_height);

  // in: height x width bytes; out: to_height x to_width bytes. Allocates nothing.
  void operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) const;

 private:
  std::size_t width_;
  LinearAxis columns_, rows_;
};

}  // namespace racebeam

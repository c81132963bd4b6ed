// Reduces planes of bytes where each target is a block of whole source cells, as OpenCV's INTER_AREA does, to
// the byte (docs/spec/environment.md, 15). Other sizes are AreaResize's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace racebeam {

// Planes are in row-major order. Thread-safe.
class BlockMean {
 public:
  static constexpr std::size_t kWidest = 256;

  // Whether the sizes are positive, and each axis shrinks by a whole number.
  static bool fits(int width, int height, int to_width, int to_height);

  // Throws std::invalid_argument if fits() is false, or if width is above kWidest.
  BlockMean(int width, int height, int to_width, int to_height);

  // in: height x width bytes; out: to_height x to_width bytes. Allocates nothing. rows: one flag for each row
  // of `out`. Rows with 0 stay as they are. Empty: all are computed.
  void operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out,
                  std::span<const std::uint8_t> rows = {}) const;

  // Sets the flags of the rows of `out` that depend on a row of `in` whose flag is not 0, and clears the
  // others.
  void depending(std::span<const std::uint8_t> changed, std::span<std::uint8_t> rows) const;

 private:
  std::uint8_t mean(std::uint32_t sum) const;

  std::size_t width_, to_width_, to_height_;
  std::size_t across_, down_;  // source cells of a block
  float share_;                // of a cell in a block
};

}  // namespace racebeam

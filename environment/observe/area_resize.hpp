// Area averaging as OpenCV's INTER_AREA, to the byte (docs/spec/environment.md, 15).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator/base/simd.hpp"

namespace racebeam {

// One axis: target t is the sum of `taps` source cells from first[t] on, weighted with weights[t * taps] and
// so on.
struct AreaAxis {
  AreaAxis(int cells, int targets);

  std::size_t taps;
  std::vector<std::size_t> first;
  std::vector<float> weights;
};

// Reduces planes of bytes, in row-major order. Thread-safe after construction.
class AreaResize {
 public:
  static constexpr std::size_t kWidest = 256;

  // Throws std::invalid_argument if a size is not positive or would grow, if to_width is above kWidest, or if
  // the height would shrink to less than a 29th.
  AreaResize(int width, int height, int to_width, int to_height, Simd form = simd());

  // in: height x width bytes; out: to_height x to_width bytes. Allocates nothing. rows: one flag for each row
  // of `out`. Rows with 0 stay as they are. Empty: all are computed.
  void operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out,
                  std::span<const std::uint8_t> rows = {}) const;

  // Sets the flags of the rows of `out` that depend on a row of `in` whose flag is not 0, and clears the
  // others.
  void depending(std::span<const std::uint8_t> changed, std::span<std::uint8_t> rows) const;

 private:
  // Eight target columns, for vectors. The source bytes of the first four, and those of the others, are
  // within 16 bytes.
  struct Octet {
    std::array<std::size_t, 2> from;
    // For each tap: indices into the 16 bytes, as 32-bit numbers, and their weights.
    std::vector<std::array<std::uint8_t, 32>> places;
    std::vector<std::array<float, 8>> weights;
  };

  bool fits_octets() const;
  void make_octets();
  template <typename Reduce>
  void run(const std::uint8_t* in, std::uint8_t* out, std::span<const std::uint8_t> rows,
           Reduce reduce) const;
  void run_plain(const std::uint8_t* in, std::uint8_t* out, std::span<const std::uint8_t> rows) const;
  void run_avx2(const std::uint8_t* in, std::uint8_t* out, std::span<const std::uint8_t> rows) const;
  void run_neon(const std::uint8_t* in, std::uint8_t* out, std::span<const std::uint8_t> rows) const;
  void reduce_plain(const std::uint8_t* row, float* to) const;
  void reduce_avx2(const std::uint8_t* row, float* to) const;
  void reduce_neon(const std::uint8_t* row, float* to) const;

  std::size_t width_;
  AreaAxis columns_, rows_;
  std::vector<Octet> octets_;  // empty: the portable variant is used
};

}  // namespace racebeam

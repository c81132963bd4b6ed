// Area averaging as OpenCV's INTER_AREA does it, to the byte (docs/spec/environment.md, 15).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator/base/simd.hpp"

namespace racebeam {

// One axis: target t is the sum of `taps` source cells from first[t] on, with weights[t * taps] and so on.
struct AreaAxis {
  AreaAxis(int cells, int targets);

  std::size_t taps;
  std::vector<std::size_t> first;
  std::vector<float> weights;
};

// Makes planes of bytes smaller, row-major. Const once it is made: any number of threads can use it.
class AreaResize {
 public:
  static constexpr std::size_t kWidest = 256;

  // Throws std::invalid_argument when to_width is above kWidest, a size is not positive or is to
  // grow, or the height is to shrink to less than a 29th.
  AreaResize(int width, int height, int to_width, int to_height, Simd form = simd());

  // in: height x width bytes; out: to_height x to_width bytes. Nothing is allocated.
  void operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) const;

 private:
  // Eight target columns, for AVX2: the source bytes of four and of four others lie within 16 each.
  struct Octet {
    std::array<std::size_t, 2> from;
    std::vector<std::array<std::uint8_t, 32>> places;  // for each tap: which of the 16, as 32-bit numbers
    std::vector<std::array<float, 8>> weights;         // for each tap
  };

  bool fits_octets() const;
  void make_octets();
  template <typename Reduce>
  void run(const std::uint8_t* in, std::uint8_t* out, Reduce reduce) const;
  void run_plain(const std::uint8_t* in, std::uint8_t* out) const;
  void run_avx2(const std::uint8_t* in, std::uint8_t* out) const;
  void reduce_plain(const std::uint8_t* row, float* to) const;
  void reduce_avx2(const std::uint8_t* row, float* to) const;

  std::size_t width_;
  AreaAxis columns_, rows_;
  std::vector<Octet> octets_;  // empty: the plain form
};

}  // namespace racebeam

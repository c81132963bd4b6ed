// Screens as learning agents take them: small, grey, the brighter of two frames, several in a stack
// (spec: environment.md, section 15; the figures of OpenCV's INTER_AREA).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

constexpr int kSmallSide = 84;
constexpr std::size_t kSmallSize = std::size_t{kSmallSide} * kSmallSide;

// Area averaging of a plane of bytes, row-major. Made once, it resizes without allocating.
class AreaResize {
 public:
  AreaResize(int width, int height, int to_width, int to_height);

  // in: height x width bytes; out: to_height x to_width bytes.
  void operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out);

 private:
  // One axis: target t is the sum of `taps` source cells from first[t] on, with weights[t * taps] and so on.
  struct Axis {
    Axis(int cells, int targets);

    std::size_t taps;
    std::vector<std::size_t> first;
    std::vector<float> weights;
  };
  void reduce(const std::uint8_t* row);  // into reduced_

  std::size_t width_;
  Axis columns_, rows_;
  std::vector<float> reduced_, sum_;
};

// The last `depth` screens of an environment, made small, oldest first; those that are not there yet are
// zero.
class SmallScreens {
 public:
  SmallScreens(int depth, int height);

  void clear();

  // Adds what `environment` shows. pooled: of each pixel, the brighter grey of its last two frames.
  void push(const Environment& environment, bool pooled);

  int depth() const { return static_cast<int>(bytes_.size() / kSmallSize); }
  std::span<const std::uint8_t> bytes() const { return bytes_; }  // depth x 84 x 84
  void set_bytes(std::span<const std::uint8_t> bytes);            // as bytes() gave them

 private:
  AreaResize resize_;
  std::vector<std::uint8_t> grey_, bytes_;
};

}  // namespace racebeam

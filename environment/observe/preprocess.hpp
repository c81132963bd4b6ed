// Screens as learning agents take them: small, grey, the brighter of two frames, several in a stack
// (docs/spec/environment.md, 15; the figures of OpenCV's INTER_AREA).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator/tia/palette.hpp"
#include "environment/environment.hpp"
#include "environment/observe/area_resize.hpp"

namespace racebeam {

constexpr int kSmallSide = 84;
constexpr std::size_t kSmallSize = std::size_t{kSmallSide} * kSmallSide;

// The grey of a picture of palette indices, or, of each pixel, the brighter grey of two. All spans are equally
// long, and a whole number of rows of 160.
void make_grey(std::span<const std::uint8_t> screen, const GreyTable& table, std::span<std::uint8_t> grey);
void make_brighter_grey(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                        const GreyTable& table, std::span<std::uint8_t> grey);

// Makes a screen of so many rows 84 x 84. One for all: it lives on.
const AreaResize& small_screen_maker(int height);

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
  const AreaResize* resize_;
  std::vector<std::uint8_t> grey_, bytes_;
};

}  // namespace racebeam

// The colours of a picture's bytes: palette, grey, and the blend of two pictures (docs/spec/palette.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "emulator/state/properties.hpp"

namespace racebeam {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

// Entry 2k is a colour, entry 2k + 1 its grey. kAuto is taken as NTSC.
using Palette = std::array<Rgb, 256>;
const Palette& palette(Format format);

// The grey of a picture's byte: the blue of the palette's entry after it. For a colour, that is its grey. For
// an odd byte, it is the next colour's blue. Byte 255 reads past the table in the reference; here it gives 0.
using GreyTable = std::array<std::uint8_t, 256>;
const GreyTable& grey_table(Format format);

// Colour averaging: each pair of bytes gives the colour nearest to their blend. An odd byte in either gives
// 0.
class Blend {
 public:
  explicit Blend(const Palette& palette);

  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const {
    return ((a | b) & 1) != 0 ? 0 : table_[index(a, b)];
  }
  void operator()(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                  std::span<std::uint8_t> out) const;

 private:
  static constexpr std::size_t index(unsigned a, unsigned b) { return (a >> 1) << 7 | b >> 1; }

  std::array<std::uint8_t, std::size_t{128} * 128> table_;
  // Whether every colour blended with itself gives itself. Not in PAL, which has some colours twice.
  bool keeps_equal_ = true;
};

// Computed on the first request, in about a millisecond; shared by all machines of the process.
const Blend& blend(Format format);

}  // namespace racebeam

// Which of the 160 pixels of a line an object covers: bit i is pixel i.
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

constexpr int kLinePixels = 160;

struct PixelMask {
  std::array<std::uint64_t, 3> word{};  // the last word uses its low 32 bits

  void clear() { word[0] = word[1] = word[2] = 0; }

  // Adds up to 33 pixels, bit 0 first, from pixel `at` (0-159) on. They wrap around at the right edge.
  void add(std::uint64_t pixels, unsigned at) {
    const unsigned shift = at % 64;
    const std::size_t first = at / 64;
    word[first] |= pixels << shift;
    if (first < 2) {
      word[first + 1] |= pixels >> 1 >> (63 - shift);
    } else {
      word[0] |= word[2] >> 32;
      word[2] &= 0xFFFFFFFF;
    }
  }

  // The pixels in [first, last).
  static PixelMask range(int first, int last) {
    const PixelMask &to_last = kBelow[static_cast<std::size_t>(last)],
                    &to_first = kBelow[static_cast<std::size_t>(first)];
    return {{to_last.word[0] & ~to_first.word[0], to_last.word[1] & ~to_first.word[1],
             to_last.word[2] & ~to_first.word[2]}};
  }

  // Eight pixels, from pixel 8 * `group` on.
  std::uint8_t byte(std::size_t group) const {
    return static_cast<std::uint8_t>(word[group / 8] >> (8 * (group % 8)));
  }

  bool any() const { return (word[0] | word[1] | word[2]) != 0; }
  bool meets(const PixelMask& other) const {
    return ((word[0] & other.word[0]) | (word[1] & other.word[1]) | (word[2] & other.word[2])) != 0;
  }

  friend PixelMask operator|(const PixelMask& a, const PixelMask& b) {
    return {{a.word[0] | b.word[0], a.word[1] | b.word[1], a.word[2] | b.word[2]}};
  }
  friend PixelMask operator&(const PixelMask& a, const PixelMask& b) {
    return {{a.word[0] & b.word[0], a.word[1] & b.word[1], a.word[2] & b.word[2]}};
  }

 private:
  static const std::array<PixelMask, kLinePixels + 1> kBelow;  // [n]: pixels 0 to n - 1
};

}  // namespace racebeam

// The portable form of Brightness, which other forms use for rows that they do not handle.
#pragma once

#include <algorithm>
#include <cstring>

#include "emulator/tia/line/pixel_mask.hpp"
#include "environment/observe/brightness.hpp"

namespace racebeam {

// Most of a row is background. A group of pixels that equals the last group is therefore copied.
struct Brightness::Plain {
  template <std::size_t pictures>
  static std::uint8_t brightest(const Brightness& own, const Rows<pictures>& rows, std::size_t x) {
    std::uint8_t most = own.of(rows[0][x]);
    if constexpr (pictures == 2) most = std::max(most, own.of(rows[1][x]));
    return most;
  }

  template <std::size_t pictures>
  static void make(const Brightness& own, const Rows<pictures>& rows, std::uint8_t* to) {
    std::array<std::uint64_t, pictures> last{};
    std::array<std::uint8_t, 8> bytes;
    bytes.fill(own.of(0));
    for (std::size_t x = 0; x < kLinePixels; x += 8) {
      std::array<std::uint64_t, pictures> pixels;
      for (std::size_t i = 0; i < pictures; ++i) std::memcpy(&pixels[i], rows[i] + x, 8);
      if (pixels != last) {
        for (std::size_t i = 0; i < 8; ++i) bytes[i] = brightest<pictures>(own, rows, x + i);
        last = pixels;
      }
      std::memcpy(to + x, bytes.data(), 8);
    }
  }
};

}  // namespace racebeam

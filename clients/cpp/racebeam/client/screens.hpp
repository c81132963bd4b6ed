/// @file
/// Colours of a screen, and stacks of screens. One thread at a time uses a ScreenStack; any number may read a
/// Palette.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/encoding.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// The colours of the field `screen`.
class Palette {
 public:
  /// @param bytes the field `palette`: red, green and blue of each value
  explicit Palette(std::span<const std::uint8_t> bytes) {
    if (bytes.size() != 3 * colours_.size()) throw std::invalid_argument("a palette has 768 bytes");
    for (std::size_t value = 0; value < colours_.size(); ++value)
      colours_[value] = 0xFF000000U | static_cast<std::uint32_t>(bytes[3 * value]) << 16 |
                        static_cast<std::uint32_t>(bytes[3 * value + 1]) << 8 | bytes[3 * value + 2];
  }

  /// 0xFFRRGGBB of a pixel's value.
  std::uint32_t colour(std::uint8_t value) const noexcept { return colours_[value]; }

  /// 0xFFRRGGBB of each pixel, row by row.
  std::vector<std::uint32_t> colours(std::span<const std::uint8_t> screen) const {
    std::vector<std::uint32_t> pixels(screen.size());
    std::transform(screen.begin(), screen.end(), pixels.begin(),
                   [this](std::uint8_t value) { return colour(value); });
    return pixels;
  }

 private:
  std::array<std::uint32_t, 256> colours_{};
};

/// A stack of screens that the client makes, as the server does for the field `grey84x84xN`: the last
/// screens, oldest first, and zeros before the first one. For `observe("grey84x84x1:delta")`, whose replies
/// are shorter than those of a stack.
class ScreenStack {
 public:
  /// @param depth screens of the stack, at least 1
  explicit ScreenStack(std::size_t depth) : depth_(depth) {
    if (depth == 0) throw std::invalid_argument("a stack has at least one screen");
  }

  /// Begins anew, as after a reset.
  void clear() { std::fill(stack_.begin(), stack_.end(), std::uint8_t{0}); }

  /// Adds a screen, which has the same size each time. Returns the stack, which the next call changes.
  const Bytes& push(std::span<const std::uint8_t> screen) {
    if (stack_.empty()) stack_.resize(depth_ * screen.size());
    if (depth_ * screen.size() != stack_.size())
      throw std::invalid_argument("the screens of a stack have one size");
    const auto size = static_cast<std::ptrdiff_t>(screen.size());
    std::copy(stack_.begin() + size, stack_.end(), stack_.begin());
    std::copy(screen.begin(), screen.end(), stack_.end() - size);
    return stack_;
  }

 private:
  std::size_t depth_;
  Bytes stack_;
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE

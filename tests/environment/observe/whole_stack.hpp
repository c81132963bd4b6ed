// What a ScreenStack is to hold.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "environment/observe/block_mean.hpp"
#include "environment/observe/screen_stack.hpp"

namespace racebeam::test {

using Bytes = std::vector<std::uint8_t>;

// The definition of a stack: reads and resizes every pixel, every time.
class WholeStack {
 public:
  WholeStack(const StackSettings& settings, const Environment& environment)
      : settings_(settings), rows_(settings.rows > 0 ? settings.rows : environment.height()) {
    if (settings.rgb) {
      tables_ = colour_tables(environment.format());
    } else {
      tables_ = std::span(&grey_table(environment.format()), 1);
    }
    planes_.assign(tables_.size(), Bytes(static_cast<std::size_t>(rows_ * kScreenWidth)));
    clear();
  }

  void clear() { screens_.assign(static_cast<std::size_t>(settings_.depth), Bytes(size())); }

  void look(const Environment& environment, bool pooled) {
    for (Bytes& plane : planes_) std::ranges::fill(plane, std::uint8_t{0});
    brighten(environment.screen());
    if (pooled) pool_with_previous(environment);
  }
  void pool_with_previous(const Environment& environment) { brighten(environment.previous_screen()); }

  void push() {
    Bytes screen(size());
    for (std::size_t channel = 0; channel < planes_.size(); ++channel) {
      const Bytes reduced = resized(planes_[channel]);
      for (std::size_t at = 0; at < reduced.size(); ++at) screen[at * planes_.size() + channel] = reduced[at];
    }
    screens_.erase(screens_.begin());
    screens_.push_back(std::move(screen));
  }

  void repeat() { std::ranges::fill(screens_, Bytes(screens_.back())); }

  Bytes bytes() const {
    Bytes all;
    for (const Bytes& screen : screens_) all.insert(all.end(), screen.begin(), screen.end());
    return all;
  }
  void set_bytes(const Bytes& bytes) {
    for (std::size_t i = 0; i < screens_.size(); ++i)
      std::ranges::copy(std::span(bytes).subspan(i * size(), size()), screens_[i].begin());
  }

 private:
  std::size_t size() const {
    return static_cast<std::size_t>(settings_.width * settings_.height) * tables_.size();
  }
  void brighten(std::span<const std::uint8_t> pixels) {
    for (std::size_t channel = 0; channel < planes_.size(); ++channel) {
      for (std::size_t at = 0; at < planes_[channel].size(); ++at)
        planes_[channel][at] = std::max(planes_[channel][at], tables_[channel][pixels[at]]);
    }
  }
  Bytes resized(const Bytes& plane) const {
    if (settings_.width == kScreenWidth && settings_.height == rows_) return plane;
    Bytes to(static_cast<std::size_t>(settings_.width * settings_.height));
    if (settings_.width > kScreenWidth || settings_.height > rows_) {
      Enlargement(kScreenWidth, rows_, settings_.width, settings_.height)(plane, to);
    } else if (BlockMean::fits(kScreenWidth, rows_, settings_.width, settings_.height)) {
      BlockMean(kScreenWidth, rows_, settings_.width, settings_.height)(plane, to);
    } else {
      AreaResize(kScreenWidth, rows_, settings_.width, settings_.height, Simd::kPlain)(plane, to);
    }
    return to;
  }

  StackSettings settings_;
  int rows_;
  std::span<const BrightnessTable> tables_;
  std::vector<Bytes> planes_, screens_;
};

}  // namespace racebeam::test

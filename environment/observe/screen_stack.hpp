// Screens as learning agents use them: resized, grey or in colour, the brighter of two frames, several in a
// stack (docs/spec/environment.md, 15; the figures of OpenCV's INTER_AREA). Most rows show what they showed
// at the last look. Those are found by the numbers of their lines, and neither read nor resized again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator/base/large_pages.hpp"
#include "environment/environment.hpp"
#include "environment/observe/preprocess.hpp"

namespace racebeam {

constexpr int kSmallSide = 84;

struct StackSettings {
  int depth = 4;                                // screens; 0: no stack
  int width = kSmallSide, height = kSmallSide;  // of each, at most twice the machine's; 0: the machine's
  bool rgb = false;  // red, green and blue of each pixel, in this order, instead of one grey
  int rows = 0;      // how many of the machine's are seen, from the top; 0: all

  int channels() const { return rgb ? 3 : 1; }
  bool operator==(const StackSettings&) const = default;
};

// The last `depth` screens of an environment; missing ones are zero.
class ScreenStack {
 public:
  // The data of each row beside its pixels: the numbers of its lines, and three flags.
  static constexpr std::size_t kBytesOfRow = 2 * sizeof(std::uint64_t) + 3;

  // For the screens of `environment`. Throws InvalidInput for a size that they cannot be resized to.
  ScreenStack(const StackSettings& settings, const Environment& environment);

  // The settings, with the screen's own width and height in place of 0. `rows` is 0 if all rows are seen.
  const StackSettings& settings() const { return settings_; }
  int depth() const { return settings_.depth; }
  std::size_t screen_size() const { return screen_size_; }  // bytes: height x width x channels
  std::size_t size() const { return screens_.size(); }      // of all screens

  void clear();  // sets all screens to zero

  // Reads the screen of `environment`. pooled: each pixel is the brighter of its last two frames.
  void look(const Environment& environment, bool pooled);
  // Makes each pixel the brighter of the screen that look() read and the environment's previous screen.
  void pool_with_previous(const Environment& environment);

  void push();    // makes the screen that look() read the newest one
  void repeat();  // makes all screens equal to the newest one

  // Oldest first. `to` has room for depth() screens, of which each takes `stride` bytes and fills the first.
  void copy_to(std::span<std::uint8_t> to, std::size_t stride) const;
  void copy_to(std::span<std::uint8_t> to) const { copy_to(to, screen_size_); }

  std::vector<std::uint8_t> bytes() const;              // as copy_to() gives them
  void set_bytes(std::span<const std::uint8_t> bytes);  // as bytes() gave them

 private:
  std::span<std::uint8_t> newest() {
    return std::span(screens_).subspan(newest_ * screen_size_, screen_size_);
  }
  std::span<std::uint8_t> plane(std::size_t channel) {
    return std::span(seen_).subspan(channel * plane_size_, plane_size_);
  }
  // The lines that a row of the planes was made from, in order: the brighter of two does not depend on it.
  struct Source {
    std::uint64_t one = 0, other = 0;  // 0 or kAnyLine: the pixels are of unknown lines
  };

  void find_stale(const Environment& environment, bool pooled);
  void find_due_rows();
  void reduce(std::size_t channel, std::span<std::uint8_t> to);
  void make_newest();
  void mark_all_changed();

  StackSettings settings_;
  const ScreenResize* resize_;          // null: screens stay as they are
  std::vector<Brightness> brightness_;  // one a channel
  std::size_t plane_size_, screen_size_;
  MachineVector<std::uint8_t> seen_;     // planes, one after the other
  MachineVector<Source> sources_;        // per row of the planes
  std::vector<std::uint8_t> stale_;      // rows of the planes that this look must compute
  std::vector<std::uint8_t> changed_;    // rows of the planes that the newest screen does not show
  std::vector<std::uint8_t> due_rows_;   // rows of the next screen that differ from the newest
  std::vector<std::uint8_t> reduced_;    // one plane, where there are several
  MachineVector<std::uint8_t> screens_;  // a ring
  std::size_t newest_ = 0;
};

}  // namespace racebeam

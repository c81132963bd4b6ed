// Whether an unobserved frame is followed without pixels or drawn anyway, whichever takes less time. That
// depends on the game and the scene. Some frames of each period are therefore run both ways, and measured.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

class DeferredRenderPolicy {
 public:
  // fixed: frames are always followed. delay: more frames until the first probe, up to kShortestPeriod. It
  // keeps machines that run side by side from drawing in their probes all at once.
  explicit DeferredRenderPolicy(bool fixed = false, unsigned delay = 0)
      : period_(fixed ? kEndless : tuning::kShortestPeriod + delay % tuning::kShortestPeriod) {}

  // Whether the next frame, which is not observed, is to be drawn. Advances to it.
  bool next_is_drawn() {
    observed_ = 0;
    if (++number_ == period_) number_ = 0, times_ = {};
    if (number_ < 2 * kProbe) return draws_ = number_ < kProbe;
    if (number_ == 2 * kProbe) decide();
    return draws_ = choice_;
  }

  // Called before each frame, after next_is_drawn() where that is called. Returns whether its time must be
  // given to record(). Observed frames between others are measured, too: they take less time after frames
  // that were drawn.
  bool measures() {
    return number_ < 2 * kProbe && number_ % kProbe >= tuning::kSettlingFrames &&
           observed_++ <= tuning::kMaxObserved;
  }
  void record(std::int64_t nanoseconds) { times_[draws_] += nanoseconds; }

 private:
  void decide() {
    const bool choice = times_[true] < times_[false];
    period_ = choice == choice_ ? std::min(2 * period_, tuning::kLongestPeriod) : tuning::kShortestPeriod;
    choice_ = choice;
  }

  static constexpr unsigned kEndless = std::numeric_limits<unsigned>::max();
  static inline const unsigned kProbe = tuning::kSettlingFrames + tuning::kMeasuredFrames;

  // Frames are followed at first. Drawing takes memory, which a machine that has only been switched on may
  // never need.
  unsigned number_ = 2 * kProbe;  // of the frame that is not observed, in its period
  unsigned period_;
  unsigned observed_ = 0;  // observed frames since the last one that was not
  bool choice_ = false, draws_ = false;
  std::array<std::int64_t, 2> times_{};  // followed, drawn
};

}  // namespace racebeam

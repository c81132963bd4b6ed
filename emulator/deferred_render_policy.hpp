// Whether a frame that is not observed is followed without pixels or drawn all the same, whichever takes less
// time. That depends on the game and the scene, so that a few frames of each period are run both ways.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace racebeam {

class DeferredRenderPolicy {
 public:
  // Whether the next frame is to be drawn. Advances to it.
  bool next_is_drawn() {
    number_ = (number_ + 1) % kPeriod;
    if (number_ == 0) work_.fill(std::numeric_limits<std::uint32_t>::max());
    draws_ = number_ < kProbe || (number_ >= 2 * kProbe && work_[1] < work_[0] - work_[0] / kMargin);
    return draws_;
  }

  // work: of the frame, Tia::work(). Not called for a frame that could not be run as planned.
  void record(std::uint32_t work) {
    if (number_ < 2 * kProbe) work_[draws_] = work;  // The last probe counts, when there are rows to recall.
  }

 private:
  static constexpr unsigned kProbe = 4, kPeriod = 512;
  // A frame is drawn if that takes less work by this part. The estimate counts instructions, and those that
  // draw take longer: measured, games with equal estimates ran 5 to 12 % slower drawn (asterix, skiing,
  // enduro).
  static constexpr unsigned kMargin = 4;

  // Frames are followed at first. Drawing takes memory, which a machine that has only been switched on may
  // never need.
  unsigned number_ = 2 * kProbe;
  bool draws_ = false;
  std::array<std::uint32_t, 2> work_{};  // followed, drawn
};

}  // namespace racebeam

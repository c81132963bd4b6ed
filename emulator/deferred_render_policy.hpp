// Whether frames that nobody looks at are followed, or drawn all the same: whichever takes less. That depends on the game,
// and on the scene; so a few frames of each period are run this way and that way.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace racebeam {

class DeferredRenderPolicy {
 public:
  // For the next one.
  bool next_is_drawn() {
    number_ = (number_ + 1) % kPeriod;
    if (number_ == 0) work_.fill(std::numeric_limits<std::uint32_t>::max());
    draws_ = number_ < kProbe || (number_ >= 2 * kProbe && work_[1] < work_[0]);
    return draws_;
  }

  // What it took: Tia::work(). A frame that can't be run the way it was meant to be tells nothing.
  void record(std::uint32_t work) {
    if (number_ < 2 * kProbe) work_[draws_] = work;  // the last of each: by then there are rows to be met again
  }

 private:
  static constexpr unsigned kProbe = 4, kPeriod = 512;

  // At first they are followed: drawing takes memory, which a machine that has only been switched on need not have.
  unsigned number_ = 2 * kProbe;
  bool draws_ = false;
  std::array<std::uint32_t, 2> work_{};  // followed, drawn
};

}  // namespace racebeam

// Busy polling. Waking a sleeping thread takes several times as long as an act on a virtual machine. If a
// client has sent its next request at once, the server therefore polls for a while before it sleeps. A client
// that takes longer, or is idle, costs nothing. If polling is often in vain, because other threads need the
// processors, the server backs off.
#pragma once

#include <algorithm>
#include <chrono>

#include "system/tuning.hpp"

namespace racebeam {

class BusyPoll {
 public:
  using Clock = std::chrono::steady_clock;

  explicit BusyPoll(std::chrono::microseconds longest) : longest_(longest) {}  // 0: never

  // Records that input came this long after the last reply. Returns whether to poll for the next input.
  bool received_after(Clock::duration pause) {
    if (until_ != Clock::time_point{} && pause < longest_) backoff_ /= 2;
    return pause < longest_;
  }

  void begin() {
    if (to_skip_ > 0) {
      --to_skip_;
    } else {
      until_ = Clock::now() + longest_;
    }
  }

  // Whether to poll again instead of sleeping.
  bool again() {
    if (until_ == Clock::time_point{} || Clock::now() < until_) return until_ != Clock::time_point{};
    until_ = {};
    to_skip_ = backoff_ = std::min(4 * backoff_ + 4, tuning::kMaxSkippedPolls);
    return false;
  }

 private:
  const std::chrono::microseconds longest_;
  Clock::time_point until_{};      // when polling ends; 0: it does not poll
  int backoff_ = 0, to_skip_ = 0;  // polls to skip: after the last vain one, and those that are left of them
};

}  // namespace racebeam

// Who sleeps is woken up late: on a virtual machine that takes several times as long as an act. A client that
// asked again at once the last time is therefore waited for awake, for a while; who thinks for longer, or is
// idle, costs nothing. Where that is often in vain, because others need the processors, it is tried ever more
// seldom.
#pragma once

#include <algorithm>
#include <chrono>

namespace racebeam {

class BusyPoll {
 public:
  using Clock = std::chrono::steady_clock;

  explicit BusyPoll(std::chrono::microseconds longest) : longest_(longest) {}  // 0: never

  // Something came, so long after the last reply: whether the next is worth waiting for.
  bool came_after(Clock::duration pause) {
    if (until_ != Clock::time_point{} && pause < longest_) vain_ /= 2;
    return pause < longest_;
  }

  void begin() {
    if (to_skip_ > 0) {
      --to_skip_;
    } else {
      until_ = Clock::now() + longest_;
    }
  }

  // Whether to look again without sleeping.
  bool again() {
    if (until_ == Clock::time_point{} || Clock::now() < until_) return until_ != Clock::time_point{};
    until_ = {};
    to_skip_ = vain_ = std::min(4 * vain_ + 4, kMostSkipped);
    return false;
  }

 private:
  static constexpr int kMostSkipped = 1024;

  const std::chrono::microseconds longest_;
  Clock::time_point until_{};   // none: asleep
  int vain_ = 0, to_skip_ = 0;  // how often not to try after the last time, and from now on
};

}  // namespace racebeam

// How much a session has used its event loop lately.
#pragma once

#include <chrono>
#include <cmath>

namespace racebeam {

class Usage {
 public:
  using Clock = std::chrono::steady_clock;

  void add(Clock::duration worked, Clock::time_point now) {
    sum_ = lately(now) + std::chrono::duration<double>(worked).count();
    at_ = now;
  }

  // Seconds of work, each weighted by a half for every kHalfLife since.
  double lately(Clock::time_point now) const {
    return sum_ * std::exp2(-std::chrono::duration<double>(now - at_).count() / kHalfLife);
  }

 private:
  static constexpr double kHalfLife = 0.1;

  double sum_ = 0;
  Clock::time_point at_{};
};

}  // namespace racebeam

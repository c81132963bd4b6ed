// How much of its event loop a session has used lately.
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

  // Seconds of work, of which each counts half for every kHalfLife that has passed since.
  double lately(Clock::time_point now) const {
    return sum_ * std::exp2(-std::chrono::duration<double>(now - at_).count() / kHalfLife);
  }

 private:
  static constexpr double kHalfLife = 0.1;

  double sum_ = 0;
  Clock::time_point at_{};
};

}  // namespace racebeam

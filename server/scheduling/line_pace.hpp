// How often a failure that repeats gets a line of the log.
#pragma once

#include <chrono>
#include <optional>

namespace racebeam {

class LinePace {
 public:
  using Clock = std::chrono::steady_clock;

  // Returns whether a line is due: for the first failure, and for the first one ten seconds after a line.
  bool is_due(Clock::time_point now) {
    if (last_ && now - *last_ < kBetweenLines) return false;
    last_ = now;
    return true;
  }

 private:
  static constexpr std::chrono::seconds kBetweenLines{10};

  std::optional<Clock::time_point> last_;  // when the last line was written
};

}  // namespace racebeam

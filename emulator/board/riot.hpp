// The 6532: RAM, timer and ports (docs/spec/riot.md). The timer is not stepped: it is computed from the cycle
// counter.
#pragma once

#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

// Reads of INTIM and INSTAT at `cycle`, and writes of the timer.
class Timer {
 public:
  Timer(RiotState& state, std::int32_t cycle)
      : state_(state), now_(static_cast<std::uint32_t>(cycle)), elapsed_(now_ - 1 - state.timer_set) {}

  std::uint8_t intim() {
    const std::int32_t count = intervals_left();
    if (count >= 0) return static_cast<std::uint8_t>(count);
    const std::uint32_t expiry = std::uint32_t{state_.timer} << state_.shift;
    if (!state_.late) {
      const auto left = static_cast<std::int32_t>(expiry - elapsed_ - 1);  // docs/spec/riot.md, 3 (d)
      if (left >= -1) return static_cast<std::uint8_t>(left);
      state_.late = 1;
      state_.late_read = now_;
    }
    return static_cast<std::uint8_t>(state_.timer - (elapsed_ >> state_.shift) -
                                     (state_.late_read - (state_.timer_set + expiry)));
  }

  std::uint8_t instat() const { return intervals_left() < 0 && !state_.late ? 0x80 : 0x00; }

  void set(std::uint8_t value, std::uint8_t shift) {
    state_.timer = value;
    state_.shift = shift;
    state_.timer_set = now_;
    state_.late = 0;
  }

 private:
  // The count of INTIM, negative once the timer has expired.
  std::int32_t intervals_left() const {
    return static_cast<std::int32_t>(state_.timer - (elapsed_ >> state_.shift) - 1);
  }

  RiotState& state_;
  std::uint32_t now_;
  std::uint32_t elapsed_;
};

// log2 of the intervals of TIM1T, TIM8T, TIM64T and T1024T.
constexpr std::uint8_t kTimerShift[4] = {0, 3, 6, 10};

}  // namespace racebeam

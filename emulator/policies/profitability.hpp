// Whether entering translated code saves time. Entering and leaving it costs as much as interpreting a few
// instructions.
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

// The entries of one machine. They affect speed only.
class Profitability {
 public:
  // Whether the last entries have been too short on average. Once in tuning::kRetry calls, it returns false
  // anyway, since another scene of the game may have longer ones.
  bool is_unprofitable() {
    if (balance_ > -tuning::kMaxDebt) return false;
    return ++searches_ % tuning::kRetry != 0;
  }

  // cycles: how many cycles one entry ran, without those in which no instruction was executed.
  void record(std::int32_t cycles) {
    balance_ =
        std::clamp(balance_ + cycles - tuning::kBreakEvenCycles, -tuning::kMaxDebt, tuning::kMaxSurplus);
  }

 private:
  std::int32_t balance_ = 0;  // cycles beyond those of break-even
  std::uint32_t searches_ = 0;
};

}  // namespace racebeam

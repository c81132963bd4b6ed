// Whether entering a block of translated code saves time. To enter and leave costs as much as interpreting a
// few instructions.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

// Statistics of one block, shared by all machines that run the image. They affect speed only.
class Profitability {
 public:
  // Whether its entries have been too short in the mean. One of tuning::kRetry times, the answer is still no,
  // since another scene of the game may have longer ones.
  bool is_unprofitable() {
    if (balance_.load(std::memory_order_relaxed) > -tuning::kMostBalance) return false;
    const std::uint8_t skipped = skipped_.load(std::memory_order_relaxed);
    skipped_.store(static_cast<std::uint8_t>(skipped + 1), std::memory_order_relaxed);
    return skipped % tuning::kRetry != 0;
  }

  // cycles: how many cycles one entry ran, without those in which no instruction was executed.
  void record(std::int32_t cycles) {
    const std::int32_t before = balance_.load(std::memory_order_relaxed);
    const std::int32_t balance =
        std::clamp(before + cycles - tuning::kBreakEvenCycles, -tuning::kMostBalance, tuning::kMostBalance);
    if (balance != before) balance_.store(static_cast<std::int16_t>(balance), std::memory_order_relaxed);
  }

  // How many instructions the block has, plus the one that it leaves to the interpreter.
  std::int32_t length() const { return length_.load(std::memory_order_relaxed); }
  void set_length(std::size_t length) {
    length_.store(static_cast<std::uint8_t>(length), std::memory_order_relaxed);
  }

 private:
  std::atomic<std::int16_t> balance_ = 0;  // cycles beyond those of break-even, within kMostBalance
  std::atomic<std::uint8_t> skipped_ = 1;
  std::atomic<std::uint8_t> length_ = 1;
};

}  // namespace racebeam

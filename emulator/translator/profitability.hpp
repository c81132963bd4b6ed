// Whether entering a block of translated code saves time. To enter and leave costs as much as interpreting a
// few instructions.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace racebeam::translator {

// Statistics of one block, shared by all machines that run the image. They affect speed only.
class Profitability {
 public:
  // An entry that runs this many cycles takes about as long as interpreting them, if some access devices.
  static constexpr std::int32_t kBreakEvenCycles = 32;

  // Whether its entries have been too short in the mean. One of kRetry times, the answer is still no,
  // since another scene of the game may have longer ones.
  bool is_unprofitable() {
    if (balance_.load(std::memory_order_relaxed) > -kMost) return false;
    const std::uint8_t skipped = skipped_.load(std::memory_order_relaxed);
    skipped_.store(static_cast<std::uint8_t>(skipped + 1), std::memory_order_relaxed);
    return skipped % kRetry != 0;
  }

  // cycles: how many cycles one entry ran, without those in which no instruction was executed.
  void record(std::int32_t cycles) {
    const std::int32_t before = balance_.load(std::memory_order_relaxed);
    const std::int32_t balance = std::clamp(before + cycles - kBreakEvenCycles, -kMost, kMost);
    if (balance != before) balance_.store(static_cast<std::int16_t>(balance), std::memory_order_relaxed);
  }

  // How many instructions the block has, plus the one that it leaves to the interpreter.
  std::int32_t length() const { return length_.load(std::memory_order_relaxed); }
  void set_length(std::size_t length) {
    length_.store(static_cast<std::uint8_t>(length), std::memory_order_relaxed);
  }

 private:
  static constexpr std::int32_t kMost = 4 * kBreakEvenCycles;
  static constexpr std::uint8_t kRetry = 64;

  std::atomic<std::int16_t> balance_ = 0;  // cycles beyond those of break-even, kMost at most on either side
  std::atomic<std::uint8_t> skipped_ = 1;
  std::atomic<std::uint8_t> length_ = 1;
};

}  // namespace racebeam::translator

// Whether entering a block of translated code saves time. To enter and leave costs as much as interpreting a
// few instructions.
#pragma once

#include <atomic>
#include <cstdint>

namespace racebeam::translator {

// Statistics of one block, shared by all machines that run the image. They affect speed only.
class Profitability {
 public:
  // An entry that runs this many cycles takes as long as interpreting them.
  static constexpr std::int32_t kBreakEvenCycles = 48;

  bool is_unprofitable() const { return losses_.load(std::memory_order_relaxed) >= kMostLosses; }

  // cycles: how many cycles one entry ran, without those in which no instruction was executed.
  void record(std::int32_t cycles) {
    const std::uint8_t losses = losses_.load(std::memory_order_relaxed);
    if (cycles < kBreakEvenCycles) {
      if (losses < kMostLosses)
        losses_.store(static_cast<std::uint8_t>(losses + 1), std::memory_order_relaxed);
    } else if (losses != 0) {
      losses_.store(0, std::memory_order_relaxed);
    }
  }

  // How many instructions the block has, plus the one that it leaves to the interpreter.
  std::int32_t length() const { return length_.load(std::memory_order_relaxed); }
  void set_length(std::size_t length) {
    length_.store(static_cast<std::uint8_t>(length), std::memory_order_relaxed);
  }

 private:
  static constexpr std::uint8_t kMostLosses = 4;  // unprofitable entries in a row

  std::atomic<std::uint8_t> losses_ = 0;
  std::atomic<std::uint8_t> length_ = 1;
};

}  // namespace racebeam::translator

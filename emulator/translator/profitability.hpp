// Whether entering translated code at a place has paid: a way in and out costs as much as interpreting a few instructions.
#pragma once

#include <atomic>
#include <cstdint>

namespace racebeam::translator {

// Of a block. All machines that run the image note what they found; nothing but speed depends on it.
class Worth {
 public:
  // Cycles of a stay that is as fast as interpreting them.
  static constexpr std::int32_t kFewestCycles = 48;

  bool is_poor() const { return vain_.load(std::memory_order_relaxed) >= kMostVain; }

  // How long a stay was, in cycles in which instructions were run.
  void note(std::int32_t cycles) {
    const std::uint8_t vain = vain_.load(std::memory_order_relaxed);
    if (cycles < kFewestCycles) {
      if (vain < kMostVain) vain_.store(static_cast<std::uint8_t>(vain + 1), std::memory_order_relaxed);
    } else if (vain != 0) {
      vain_.store(0, std::memory_order_relaxed);
    }
  }

  // Instructions up to where the block ends, the one that it leaves to the interpreter included.
  std::int32_t length() const { return length_.load(std::memory_order_relaxed); }
  void set_length(std::size_t length) { length_.store(static_cast<std::uint8_t>(length), std::memory_order_relaxed); }

 private:
  static constexpr std::uint8_t kMostVain = 4;  // stays in a row

  std::atomic<std::uint8_t> vain_ = 0;
  std::atomic<std::uint8_t> length_ = 1;
};

}  // namespace racebeam::translator

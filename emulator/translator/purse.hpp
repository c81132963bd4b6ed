// What a machine may spend on making code. Translation pays later or not at all, so a part of the time that the machine has
// run is all that may be spent on it: then no program takes much longer than interpreted (docs/translator.md).
#pragma once

#include <time.h>

#include <algorithm>
#include <cstdint>

namespace racebeam::translator {

// Processor time of this thread, in nanoseconds.
inline std::int64_t processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

class Purse {
 public:
  // endless: all that is met is translated at once, whatever it costs.
  explicit Purse(bool endless) : left_(endless ? kMost : 0), endless_(endless) {}

  // Around each step of the machine. The clock is looked at only as long as there is room for more.
  void begin_step() { began_ = is_full() ? 0 : processor_time(), spent_ = 0; }
  void end_step() {
    if (began_ != 0) left_ = std::min(left_ + (processor_time() - began_ - spent_) * kPart / 100, kMost);
  }

  bool affords_batch() const { return left_ >= kLikelyPrice; }
  void pay(std::int64_t price) {
    spent_ += price;
    if (!endless_) left_ -= price;
  }
  bool is_endless() const { return endless_; }

 private:
  static constexpr std::int64_t kPart = 35;  // percent of the time that is run
  static constexpr std::int64_t kMost = 4'000'000;
  static constexpr std::int64_t kLikelyPrice = 30'000;  // of a batch: a dearer one is paid off later

  bool is_full() const { return left_ == kMost; }

  std::int64_t left_, began_ = 0, spent_ = 0;  // nanoseconds
  bool endless_;
};

}  // namespace racebeam::translator

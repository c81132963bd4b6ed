// What a machine may spend on making code. Translation pays later or not at all, so a part of the time that the machine has
// run is all that may be spent on it: then no program takes much longer than interpreted (docs/translator.md).
#pragma once

#include <x86intrin.h>

#include <algorithm>
#include <cstdint>

namespace racebeam::translator {

// The processor's time stamp counter: some two to four ticks a nanosecond. The system's clocks take as long as short frames.
inline std::int64_t ticks() { return static_cast<std::int64_t>(__rdtsc()); }

class Purse {
 public:
  // endless: all that is met is translated at once, whatever it costs.
  explicit Purse(bool endless) : left_(endless ? kMost : 0), endless_(endless) {}

  // Around each step of the machine. The clock is looked at only as long as there is room for more.
  void begin_step() { began_ = is_full() ? 0 : ticks(), spent_ = 0; }
  void end_step() {
    if (began_ != 0) left_ = std::min(left_ + std::min(ticks() - began_ - spent_, kLongestStep) * kPart / 100, kMost);
  }

  // What is done while it lives is paid for.
  class Payment {
   public:
    explicit Payment(Purse& from) : purse_(from) {}
    Payment(const Payment&) = delete;
    Payment& operator=(const Payment&) = delete;
    ~Payment() { purse_.pay(ticks() - began_); }

   private:
    Purse& purse_;
    const std::int64_t began_ = ticks();
  };

  bool affords_batch() const { return left_ >= kLikelyPrice; }
  bool is_endless() const { return endless_; }

 private:
  void pay(std::int64_t price) {
    spent_ += price;
    if (!endless_) left_ -= price;
  }

  static constexpr std::int64_t kPart = 25;  // percent of the time that is run
  static constexpr std::int64_t kLongestStep = 1'000'000;  // what is longer, another thread has run in
  static constexpr std::int64_t kMost = 10'000'000;
  static constexpr std::int64_t kLikelyPrice = 60'000;  // of a batch: a dearer one is paid off later

  bool is_full() const { return left_ == kMost; }

  std::int64_t left_, began_ = 0, spent_ = 0;  // ticks
  bool endless_;
};

}  // namespace racebeam::translator

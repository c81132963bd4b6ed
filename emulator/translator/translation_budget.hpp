// How much time a machine may spend on translation. Translation saves time later or never. The budget is
// therefore a fixed part of the time that the machine has run: no program takes much longer than interpreted
// (docs/translator.md).
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/translator/ticks.hpp"

namespace racebeam::translator {

class TranslationBudget {
 public:
  // unlimited: the budget covers every batch, whatever it costs.
  explicit TranslationBudget(bool unlimited)
      : balance_(unlimited ? kCapacity : -kStartCost), unlimited_(unlimited) {}

  // Called around each step of the machine. While the budget is full, the counter is not read.
  void begin_step() { began_ = is_full() ? 0 : ticks(), spent_ = 0; }
  void end_step() {
    if (began_ != 0)
      balance_ =
          std::min(balance_ + std::min(ticks() - began_ - spent_, kLongestStep) * percent() / 100, kCapacity);
  }

  // Charges the time from its construction to its destruction.
  class Charge {
   public:
    explicit Charge(TranslationBudget& from) : budget_(from) {}
    Charge(const Charge&) = delete;
    Charge& operator=(const Charge&) = delete;
    ~Charge() { budget_.charge(ticks() - began_); }

   private:
    TranslationBudget& budget_;
    const std::int64_t began_ = ticks();
  };

  bool covers_batch() const { return balance_ >= kBatchCost; }
  bool is_unlimited() const { return unlimited_; }
  // What was charged in this step, in ticks.
  std::int64_t spent() const { return spent_; }

 private:
  void charge(std::int64_t cost) {
    spent_ += cost;
    total_ += cost;
    if (!unlimited_) balance_ -= cost;
  }

  // The part of the machine's time that is added. Beyond what translation of most games takes, it is small:
  // such a program is hardly worth the work.
  std::int64_t percent() const { return total_ < kUsualTotal ? 20 : 5; }

  static constexpr std::int64_t kUsualTotal = 12'000'000;
  // Longer steps are cut: another thread used the processor.
  static constexpr std::int64_t kLongestStep = 1'000'000;
  static constexpr std::int64_t kCapacity = 10'000'000;
  // What the system does for the memory of the code, beyond what is charged: pages of short-lived machines.
  static constexpr std::int64_t kStartCost = 500'000;
  static constexpr std::int64_t kBatchCost = 60'000;  // usual; a batch that costs more leaves a debt

  bool is_full() const { return balance_ == kCapacity; }

  std::int64_t balance_, began_ = 0, spent_ = 0, total_ = 0;  // ticks; charged in this step, and in all
  bool unlimited_;
};

}  // namespace racebeam::translator

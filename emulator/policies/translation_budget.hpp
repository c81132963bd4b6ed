// How much time a machine may spend on translation. Translation saves time later or never. The budget is
// therefore a credit, and a fixed part of the time that the machine has run: no program takes much longer
// than interpreted (docs/translator.md).
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/base/stopwatch.hpp"
#include "emulator/policies/tuning.hpp"

namespace racebeam {

// All times are nanoseconds. Other programs can lengthen both a step and a batch. Of either, no more counts
// than the longest takes on a quiet machine.
class TranslationBudget {
 public:
  // unlimited: the budget covers every batch, whatever it costs.
  explicit TranslationBudget(bool unlimited, const Clocks& clocks = host_clocks())
      : clocks_(clocks),
        balance_(unlimited ? tuning::kCapacity : tuning::kCredit - tuning::kStartCost),
        unlimited_(unlimited) {}

  // Called around each step of the machine. While the budget is full, no clock is read.
  void begin_step() {
    spent_ = 0;
    earns_ = !is_full();
    if (earns_) began_ = clocks_.wall();
  }
  void end_step() {
    if (!earns_) return;
    const std::int64_t ran = std::min(clocks_.wall() - began_ - spent_, tuning::kLongestStep);
    balance_ = std::min(balance_ + ran * percent() / 100, tuning::kCapacity);
  }

  // Charges the time from its construction to its destruction.
  class Charge {
   public:
    explicit Charge(TranslationBudget& from) : budget_(from), watch_(from.clocks_) {}
    Charge(const Charge&) = delete;
    Charge& operator=(const Charge&) = delete;
    ~Charge() { budget_.charge(watch_.elapsed()); }

   private:
    TranslationBudget& budget_;
    const Stopwatch watch_;
  };

  bool covers_batch() const { return balance_ >= tuning::kBatchCost; }
  bool is_unlimited() const { return unlimited_; }
  // What translation took in this step.
  std::int64_t spent() const { return spent_; }

 private:
  void charge(std::int64_t cost) {
    spent_ += cost;
    if (unlimited_) return;
    ++batches_;
    balance_ -= std::min(cost, tuning::kLongestBatch);
  }

  // The part of the machine's time that is added.
  std::int64_t percent() const {
    return batches_ < tuning::kUsualBatches ? tuning::kUsualPercent : tuning::kLatePercent;
  }

  bool is_full() const { return balance_ == tuning::kCapacity; }

  const Clocks& clocks_;
  std::int64_t balance_, began_ = 0, spent_ = 0;  // spent in this step
  int batches_ = 0;
  bool unlimited_, earns_ = false;
};

}  // namespace racebeam

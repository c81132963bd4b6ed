// What a machine may spend on being translated, and what that costs: so much of the time that the interpreter
// alone would take, and no more (docs/translator.md, "What it may cost").
//
// The unit is the time of one of the quickest interpreted instructions, 1.2 ns. No clock is looked at: prices
// are what was measured once (tests/translator/costs.cpp), so that two runs do the same.
#pragma once

#include <algorithm>
#include <cstdint>

namespace racebeam::translator {

using Cost = std::int64_t;

// Of things done once.
constexpr Cost kImagePrice = 25000;   // code memory for an image, mapped and unmapped
constexpr Cost kViewPrice = 8000;     // a window's table of entries
constexpr Cost kBatchPrice = 8000;    // to begin a batch, and to make it executable
constexpr Cost kFindingPrice = 50;    // an instruction: to find it, and what may follow it
constexpr Cost kBlockPrice = 300;     // a block without its instructions
constexpr Cost kEmittingPrice = 500;  // an instruction in a block
// Of things done again and again.
constexpr Cost kEntryPrice = 25;    // into translated code and out again
constexpr Cost kStretchPrice = 50;  // into the interpreter and out again
constexpr Cost kCountingPrice = 4;  // an instruction that the interpreter runs in a stretch that is counted
constexpr Cost kWindowPrice = 80;   // a window that the machine did not have at hand

// Earned by running, up to a limit. Spending may lead below zero: then nothing is bought until that is
// earned.
class Purse {
 public:
  explicit Purse(Cost most, Cost balance = 0) : balance_(balance), most_(most) {}

  void earn(Cost cost) { balance_ = std::min(balance_ + cost, most_); }
  void spend(Cost cost) { balance_ -= cost; }
  bool is_empty() const { return balance_ <= 0; }
  bool can_pay(Cost cost) const { return balance_ >= cost; }

 private:
  Cost balance_;
  Cost most_;
};

// What a step has done on the processor's side.
struct Work {
  Cost interpreted = 0;  // instructions
  Cost translated = 0;   // cycles that were no waiting
  Cost calls = 0;        // accesses in them that take as long as ever

  // Instructions, at the least, that took less time than they would have.
  Cost quick() const { return std::max<Cost>(translated / kCyclesAnInstruction - calls, 0); }
  Cost all() const { return interpreted + translated / kCyclesAnInstruction; }

  static constexpr Cost kCyclesAnInstruction = 4;
};

// Two purses, so that code that is left often does not keep other code from being made.
struct Budget {
  Purse making{400000};  // code: the limit is what one step may spend at a time
  Purse moving{20000};   // between translated code and the interpreter

  // That nothing is too dear for.
  static Budget boundless() { return {Purse(kBoundless, kBoundless), Purse(kBoundless, kBoundless)}; }

  // Of a step. drawing: Tia::work(). It takes that long in any case.
  void earn(const Work& work, std::uint32_t drawing) {
    making.earn((work.interpreted + work.quick() + drawing / kDrawingAUnit) * 5 / 16);
    moving.earn(work.interpreted / 16);
  }

  // At once, when translated code has been left: quick instructions save more than what they took.
  void move(Cost quick) { moving.earn(quick * 5 / 4 - kEntryPrice); }

  static constexpr Cost kBoundless = Cost{1} << 60;
  static constexpr std::uint32_t kDrawingAUnit = 10;
  static constexpr Cost kEnoughToMove = 4000;  // for a step to begin with, so that it gets into its stride
};

}  // namespace racebeam::translator

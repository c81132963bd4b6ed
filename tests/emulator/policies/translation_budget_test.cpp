#include "emulator/policies/translation_budget.hpp"

#include <catch2/catch.hpp>
#include <utility>

using racebeam::Clocks;
using racebeam::TranslationBudget;

namespace {

constexpr std::int64_t kMicrosecond = 1000, kMillisecond = 1'000'000, kSecond = 1'000'000'000;
constexpr std::int64_t kStep = 10 * kMicrosecond, kBatch = 20 * kMicrosecond;

// Clocks that pass only when the tests say so.
std::int64_t wall, processor;
const Clocks kClocks{[] { return wall; }, [] { return processor; }};

void work(std::int64_t time) { wall += time, processor += time; }
void wait(std::int64_t time) { wall += time; }

// Runs steps that want a batch each. Returns how many batches the budget covered. during_batch: what happens
// in each, by its number.
template <class Function>
int run(TranslationBudget& budget, int steps, Function during_batch) {
  int batches = 0;
  for (int step = 0; step < steps; ++step) {
    budget.begin_step();
    work(kStep);
    if (budget.covers_batch()) {
      const TranslationBudget::Charge charge(budget);
      during_batch(batches++);
    }
    budget.end_step();
  }
  return batches;
}

int run(TranslationBudget& budget, int steps) {
  return run(budget, steps, [](int) { work(kBatch); });
}

TEST_CASE("Translation goes on after another program has taken the processor in a batch") {
  for (const std::int64_t pause : {5 * kMillisecond, 50 * kMillisecond, 10 * kSecond}) {
    TranslationBudget quiet(false, kClocks), busy(false, kClocks);
    const int undisturbed = run(quiet, 300);
    CHECK(run(busy, 300, [pause](int batch) {
            work(kBatch);
            if (batch % 4 == 3) wait(pause);
          }) >= undisturbed);
  }
}

TEST_CASE("Translation goes on after a pause that the processor's clock counts as work") {
  TranslationBudget quiet(false, kClocks), busy(false, kClocks);
  run(quiet, 100), run(busy, 100);
  run(busy, 1, [](int) { work(50 * kMillisecond); });
  CHECK(run(busy, 1000) > run(quiet, 1000) - 50);
}

TEST_CASE("Where the processor's clock stands still, the wall's clock is charged") {
  TranslationBudget fine(false, kClocks), coarse(false, kClocks);
  const int batches = run(fine, 1000);
  CHECK(run(coarse, 1000, [](int) { wait(kBatch); }) == batches);
}

TEST_CASE("Pauses in steps do not add to the budget of a program that translates without end") {
  TranslationBudget quiet(false, kClocks), busy(false, kClocks);
  run(quiet, 1000), run(busy, 1000);
  const int undisturbed = run(quiet, 1000);
  busy.begin_step();
  wait(kSecond);
  busy.end_step();
  CHECK(run(busy, 1000) <= undisturbed + 5);
}

constexpr std::int64_t kCredit = 550 * kMicrosecond;  // without what the system takes

// Spends the credit, and the little that the steps meanwhile add.
void spend_credit(TranslationBudget& budget) { run(budget, 100); }

TEST_CASE("A program translates on credit at first, and then only as it has run") {
  TranslationBudget budget(false, kClocks);
  const int at_once = static_cast<int>(kCredit / kBatch);
  CHECK(run(budget, at_once - 1) == at_once - 1);
  std::int64_t charged = (at_once - 1) * kBatch;
  for (int steps = at_once; steps <= 2000; ++steps) {
    charged += run(budget, 1) * kBatch;
    REQUIRE(charged <= kCredit + steps * kStep / 5);
  }
}

TEST_CASE("Translation takes a fifth of a program's time, then a twentieth") {
  TranslationBudget budget(false, kClocks);
  spend_credit(budget);
  const auto share = [&](int steps) {
    return static_cast<double>(run(budget, steps) * kBatch) / static_cast<double>(steps * kStep);
  };
  CHECK(share(1000) == Approx(0.2).margin(0.02));
  share(3000);
  CHECK(share(10000) == Approx(0.05).margin(0.01));
}

TEST_CASE("A batch that costs much more than the usual one is paid for before the next") {
  TranslationBudget budget(false, kClocks);
  run(budget, 100);
  CHECK(run(budget, 100, [](int) { work(300 * kMicrosecond); }) == 1);
}

// Runs batches until the budget covers no more. Returns how many it covered.
int drain(TranslationBudget& budget) {
  int batches = 0;
  for (; budget.covers_batch(); ++batches) {
    const TranslationBudget::Charge charge(budget);
    work(25 * kMicrosecond);
  }
  return batches;
}

void charge(TranslationBudget& budget, std::int64_t time) {
  const TranslationBudget::Charge charging(budget);
  work(time);
}

void step(TranslationBudget& budget, std::int64_t time) {
  budget.begin_step();
  work(time);
  budget.end_step();
}

// Runs steps of this time until the budget covers a batch.
int steps_until_covered(TranslationBudget& budget, std::int64_t time) {
  int steps = 0;
  for (; !budget.covers_batch(); ++steps) step(budget, time);
  return steps;
}

TEST_CASE("The credit covers 22 batches of the usual cost") {
  TranslationBudget budget(false, kClocks);
  CHECK(drain(budget) == 22);
  CHECK_FALSE(budget.covers_batch());
}

TEST_CASE("A fifth of a step is added, of 0.4 ms at most") {
  for (const std::int64_t time : {400 * kMicrosecond, 10 * kMillisecond}) {
    TranslationBudget budget(false, kClocks);
    drain(budget);
    step(budget, time);
    CHECK(drain(budget) == 3);  // 80 us, and 5 are left
    step(budget, 100 * kMicrosecond);
    CHECK(budget.covers_batch());
  }
  TranslationBudget budget(false, kClocks);
  drain(budget);
  step(budget, 124 * kMicrosecond);
  CHECK_FALSE(budget.covers_batch());
  step(budget, 1 * kMicrosecond);
  CHECK(budget.covers_batch());
}

TEST_CASE("Of a batch, 0.4 ms are charged at most") {
  for (const std::int64_t time : {400 * kMicrosecond, 10 * kMillisecond}) {
    TranslationBudget budget(false, kClocks);
    drain(budget);
    charge(budget, time);
    CHECK(steps_until_covered(budget, 125 * kMicrosecond) == 17);  // 425 us
  }
}

TEST_CASE("What translation takes in a step does not count as time that the program has run") {
  TranslationBudget budget(false, kClocks);
  drain(budget);
  budget.begin_step();
  charge(budget, 300 * kMicrosecond);
  CHECK(budget.spent() == 300 * kMicrosecond);
  work(100 * kMicrosecond);
  budget.end_step();
  CHECK(steps_until_covered(budget, 100 * kMicrosecond) == 16);  // 300 us less 20, and 25
  budget.begin_step();
  CHECK(budget.spent() == 0);
}

TEST_CASE("After 256 batches, a twentieth of a step is added") {
  for (const auto& [batches, covered] : {std::pair(255, true), std::pair(256, false)}) {
    TranslationBudget budget(false, kClocks);
    for (int batch = drain(budget); batch < batches; ++batch) charge(budget, 0);
    step(budget, 400 * kMicrosecond);
    CHECK(budget.covers_batch() == covered);
  }
}

int reads;  // of the wall's clock
const Clocks kCountingClocks{[] { return ++reads, wall; }, [] { return processor; }};

TEST_CASE("A budget holds 4 ms, and no clock is read while it is full") {
  TranslationBudget budget(false, kCountingClocks);
  for (int steps = 0; steps < 44; ++steps) step(budget, 400 * kMicrosecond);
  reads = 0;
  step(budget, 400 * kMicrosecond);
  CHECK(reads == 0);
  CHECK(drain(budget) == 160);
  reads = 0;
  step(budget, 400 * kMicrosecond);
  CHECK(reads == 2);
}

TEST_CASE("An unlimited budget covers every batch, and says what each step spent") {
  TranslationBudget budget(true, kClocks);
  CHECK(run(budget, 1000, [](int) { work(kSecond); }) == 1000);
  CHECK(budget.spent() == kSecond);
}

}  // namespace

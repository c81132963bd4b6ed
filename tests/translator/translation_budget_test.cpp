#include "emulator/translator/translation_budget.hpp"

#include <catch2/catch.hpp>

using racebeam::Clocks;
using racebeam::translator::TranslationBudget;

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

constexpr std::int64_t kCredit = 600 * kMicrosecond;  // without what the system takes

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

TEST_CASE("An unlimited budget covers every batch, and says what each step spent") {
  TranslationBudget budget(true, kClocks);
  CHECK(run(budget, 1000, [](int) { work(kSecond); }) == 1000);
  CHECK(budget.spent() == kSecond);
}

}  // namespace

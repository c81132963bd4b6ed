// Whether each policy that affects speed only pays: the work with it, beside the work without it. A scene is
// one for which the policy was made, or one in which it must not cost much. Work is counted by fixed costs,
// so that no clock is read. scripts/bench tune measures the same in time.
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>

#include "emulator/policies/deferred_render_policy.hpp"
#include "emulator/policies/interpreted_run.hpp"
#include "emulator/policies/profitability.hpp"
#include "emulator/policies/step_backoff.hpp"
#include "emulator/policies/step_trial.hpp"
#include "emulator/policies/translation_budget.hpp"
#include "emulator/tia/line_cache/line_cache.hpp"

using namespace racebeam;

namespace {

constexpr int kTimes = 20'000;  // frames, steps or searches of a scene

// Frames that are not observed.
std::int64_t deferred(bool fixed, std::int64_t followed, std::int64_t drawn) {
  DeferredRenderPolicy policy(fixed);
  std::int64_t work = 0;
  for (int frame = 0; frame < kTimes; ++frame) {
    const std::int64_t cost = policy.next_is_drawn() ? drawn : followed;
    if (policy.measures()) policy.record(cost);
    work += cost;
  }
  return work;
}

TEST_CASE("To draw frames that are not observed pays where that takes less work") {
  CHECK(deferred(false, 7500, 6000) < deferred(true, 7500, 6000) * 82 / 100);
  CHECK(deferred(false, 7000, 9000) < deferred(true, 7000, 9000) * 101 / 100);
}

std::int64_t tried(std::int64_t translated, std::int64_t interpreted) {
  StepTrial trial;
  std::int64_t work = 0;
  for (int step = 0; step < kTimes; ++step) {
    const std::int64_t cost = trial.begin_step() ? interpreted : translated;
    if (trial.measures()) trial.end_step(cost);
    work += cost;
  }
  return work;
}

TEST_CASE("Trials of steps pay where the interpreter is faster") {
  CHECK(tried(160, 100) < kTimes * 105);
  CHECK(tried(100, 300) < kTimes * 101);
}

std::int64_t now;
const Clocks kClocks{[] { return now; }, [] { return now; }};

// Steps of a program that wants this many batches, one in each step until it has them. A step takes more
// without.
std::int64_t budgeted(bool unlimited, int batches, std::int64_t step, std::int64_t more, std::int64_t batch) {
  TranslationBudget budget(unlimited, kClocks);
  const std::int64_t began = now;
  for (int number = 0; number < kTimes; ++number) {
    budget.begin_step();
    if (batches > 0 && budget.covers_batch()) {
      const TranslationBudget::Charge charge(budget);
      now += batch;
      --batches;
    }
    now += batches > 0 ? step + more : step;
    budget.end_step();
  }
  return now - began;
}

TEST_CASE("A budget for translation pays in programs that want code without end") {
  CHECK(budgeted(false, kTimes, 50'000, 0, 100'000) < budgeted(true, kTimes, 50'000, 0, 100'000) * 40 / 100);
  CHECK(budgeted(false, 200, 50'000, 50'000, 25'000) <
        budgeted(true, 200, 50'000, 50'000, 25'000) * 102 / 100);
}

// Searches that find code which runs for these numbers of cycles, in turns. To enter it costs some beside a
// fifth of them.
std::int64_t entered(bool always, std::array<std::int32_t, 2> cycles) {
  constexpr std::int64_t kEntry = 26;
  Profitability profitability;
  std::int64_t work = 0;
  for (std::size_t search = 0; search < kTimes; ++search) {
    const std::int32_t next = cycles[search % 2];
    if (!always && profitability.is_unprofitable()) {
      work += next;
      continue;
    }
    work += kEntry + next / 5;
    profitability.record(next);
  }
  return work;
}

TEST_CASE("To interpret code that is left at once pays, and does not harm what pays") {
  CHECK(entered(false, {8, 8}) < entered(true, {8, 8}) * 35 / 100);
  CHECK(entered(false, {200, 200}) == entered(true, {200, 200}));
  CHECK(entered(false, {8, 200}) == entered(true, {8, 200}));
}

constexpr std::int64_t kSearch = 6;  // instructions

// Instructions of which none is translated, or of which each search after another finds code that is worth
// it.
std::int64_t searched(bool finds) {
  InterpretedRun run;
  std::int64_t work = 0;
  for (std::int64_t done = 0; done < kTimes;) {
    const std::int32_t length = run.next(1);
    done += length;
    work += length + kSearch;
    if (finds) run.reset();
  }
  return work;
}

TEST_CASE("Longer runs of the interpreter pay where nothing is worth entering") {
  constexpr std::int64_t kEachTime = kTimes * (1 + kSearch);
  CHECK(searched(false) < kEachTime * 16 / 100);
  CHECK(searched(true) == kEachTime);
}

// Steps of which one in each period is too long for translated code.
std::int64_t backed_off(bool backs_off, int period) {
  constexpr std::int64_t kTranslated = 100, kInterpreted = 160;
  StepBackoff backoff;
  std::int64_t work = 0;
  for (int step = 0; step < kTimes; ++step) {
    if (backs_off && backoff.skips_step()) {
      work += kInterpreted;
      continue;
    }
    const bool whole = step % period != 0;
    work += whole ? kTranslated : kTranslated + kInterpreted;
    backoff.record(whole);
  }
  return work;
}

TEST_CASE("To interpret steps after one that was too long pays where all are") {
  CHECK(backed_off(true, 1) < backed_off(false, 1) * 63 / 100);
  CHECK(backed_off(true, 100) < backed_off(false, 100) * 101 / 100);
}

// Rows that are drawn, of 40, if the first ones show something else in each other frame, and all scroll or
// not.
std::int64_t drawn_rows(unsigned flickering, bool scrolls) {
  LineCache cache;
  std::int64_t drawn = 0;
  for (unsigned frame = 0; frame < kTimes; ++frame) {
    cache.begin_frame();
    cache.aim(40);
    for (unsigned row = 0; row < cache.rows(); ++row) {
      LineRecord& record = cache.row(row);
      const unsigned content = scrolls ? frame : (row < flickering && frame % 2 == 0 ? 2U : 1U);
      if (!record.is_open() && record.event[0] == content) continue;
      record.open({});
      record.count = 1;
      record.event[0] = content;
      cache.add(record);
      ++drawn;
    }
  }
  return drawn;
}

TEST_CASE("A second set of records pays in games that flicker") {
  CHECK(drawn_rows(20, false) < std::int64_t{kTimes} * 20 * 3 / 100);
  CHECK(drawn_rows(0, true) == std::int64_t{kTimes} * 40);
}

}  // namespace

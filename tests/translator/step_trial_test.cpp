#include "emulator/translator/step_trial.hpp"

#include <catch2/catch.hpp>
#include <functional>

using racebeam::translator::StepTrial;

namespace {

// Runs steps, whose cost depends on their number and on whether they are interpreted. Returns how many were
// interpreted.
int run(StepTrial& trial, int steps, const std::function<int(int step, bool interpreted)>& cost) {
  int count = 0;
  for (int step = 0; step < steps; ++step) {
    const bool interpreted = trial.begin_step();
    count += interpreted ? 1 : 0;
    if (trial.measures()) trial.end_step(cost(step, interpreted));
  }
  return count;
}

TEST_CASE("Steps that are faster translated are rarely interpreted") {
  StepTrial trial;
  CHECK(run(trial, 10000, [](int, bool interpreted) { return interpreted ? 200 : 100; }) < 50);
}

TEST_CASE("Steps that are slower translated are soon interpreted, and rarely tried again") {
  StepTrial trial;
  const auto cost = [](int, bool interpreted) { return interpreted ? 100 : 160; };
  CHECK(run(trial, 300, cost) > 60);
  CHECK(run(trial, 10000, cost) > 9800);
}

TEST_CASE("A way that is a little slower is kept") {
  StepTrial trial;
  CHECK(run(trial, 10000, [](int, bool interpreted) { return interpreted ? 100 : 120; }) < 50);
}

TEST_CASE("Steps that differ with their place among four are compared with their like") {
  for (const int place : {0, 1, 2, 3}) {
    const auto with = [place](int translated) {
      return [place, translated](int step, bool interpreted) {
        return (step % 4 == place ? 5 : 1) * (interpreted ? 100 : translated);
      };
    };
    StepTrial faster, slower;
    CHECK(run(faster, 10000, with(80)) < 50);
    CHECK(run(slower, 10000, with(160)) > 9500);
  }
}

TEST_CASE("A single slow step changes nothing") {
  StepTrial trial;
  CHECK(run(trial, 10000, [](int step, bool interpreted) {
          return step == 132 ? 100000 : interpreted ? 200 : 100;
        }) < 50);
}

TEST_CASE("Most steps are translated where other programs lengthen one of sixteen") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    unsigned random = seed;
    StepTrial trial;
    const auto cost = [&random](int, bool interpreted) {
      random = random * 1664525 + 1013904223;
      return (interpreted ? 200 : 100) * (random >> 24 < 256 / 16 ? 20 : 1);
    };
    INFO(seed);
    CHECK(run(trial, 6000, cost) < 600);
  }
}

TEST_CASE("A scene that runs faster translated is translated again") {
  StepTrial trial;
  run(trial, 3000, [](int, bool interpreted) { return interpreted ? 100 : 200; });
  const auto cost = [](int, bool interpreted) { return interpreted ? 200 : 100; };
  run(trial, 1000, cost);
  CHECK(run(trial, 1000, cost) < 20);
}

}  // namespace

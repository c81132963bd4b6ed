#include "emulator/policies/step_trial.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <vector>

using racebeam::StepTrial;

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

// The steps that run in the way that is not the usual one, of those in which one way has always won.
std::vector<int> interpreted_steps(int steps, int translated, int interpreted) {
  StepTrial trial;
  std::vector<int> found;
  for (int step = 0; step < steps; ++step) {
    const bool is_interpreted = trial.begin_step();
    if (is_interpreted) found.push_back(step);
    if (trial.measures()) trial.end_step(is_interpreted ? interpreted : translated);
  }
  return found;
}

TEST_CASE("The first trial comes after 128 steps, and four of them are a round, after which pauses double") {
  CHECK(interpreted_steps(260, 100, 200) ==
        std::vector{129, 136, 143, 150, 161, 172, 183, 194, 213, 232, 251});
}

TEST_CASE("Pauses grow eightfold where the other way takes more than twice as long") {
  CHECK(interpreted_steps(700, 100, 201) == std::vector{129, 136, 143, 150, 185, 220, 255, 290, 549});
}

TEST_CASE("Pauses between trials are no longer than 1024 steps") {
  CHECK(interpreted_steps(50000, 100, 200).size() - interpreted_steps(50000 - 10 * 1027, 100, 200).size() ==
        10);
}

TEST_CASE("Three lost rounds in turn change the usual way, and pauses are then no longer than 64 steps") {
  const std::vector<int> steps = interpreted_steps(10000, 200, 100);
  CHECK(std::vector(steps.begin(), steps.begin() + 12) ==
        std::vector{129, 136, 143, 150, 157, 164, 171, 178, 185, 192, 199, 206});
  CHECK(steps[12] == 208);
  const std::vector<int> longer = interpreted_steps(10000 + 10 * 67, 200, 100);
  CHECK(longer.size() - steps.size() == 10 * 66);
}

TEST_CASE("The winner of a round is faster by more than a quarter") {
  CHECK(interpreted_steps(1000, 125, 100).size() < 50);
  CHECK(interpreted_steps(1000, 126, 100).size() > 500);
}

// Whether steps are interpreted after rounds in which the four trials' interpreted steps cost one each,
// counted twice, and the eight translated steps `present` together.
bool changes_at(int present) {
  StepTrial trial;
  int measured = 0;  // translated steps
  return run(trial, 1000, [&](int, bool interpreted) {
           const int place = interpreted ? 0 : measured++ % 8;
           return interpreted ? 1 : present / 8 + (place < present % 8 ? 1 : 0);
         }) > 500;
}

TEST_CASE("Eight steps of the usual way lose against four of the other from eleven on") {
  CHECK_FALSE(changes_at(10));
  CHECK(changes_at(11));
}

TEST_CASE("Three steps are measured after the first pause, and then three after each pause of four") {
  StepTrial trial;
  std::vector<int> measured;
  for (int step = 0; step < 140; ++step) {
    trial.begin_step();
    if (!trial.measures()) continue;
    measured.push_back(step);
    trial.end_step(100);
  }
  CHECK(measured == std::vector{128, 129, 130, 135, 136, 137});
}

TEST_CASE("A round that is won in between begins the count of lost ones anew") {
  StepTrial trial;
  int trials = 0;
  const int interpreted = run(trial, 4000, [&trials](int, bool is_interpreted) {
    const int round = trials++ / 12;  // 12 steps each
    return is_interpreted ? 100 : round % 3 == 2 ? 90 : 200;
  });
  CHECK(interpreted < 700);
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

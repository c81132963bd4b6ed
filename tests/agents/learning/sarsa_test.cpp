#include "agents/learning/sarsa.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace racebeam;

namespace {

ActiveFeatures active(std::vector<std::uint32_t> indices) { return {std::move(indices), {}}; }

// Step size 1/2, no exploration, plain rewards: every number below is a sum of powers of two.
SarsaSettings plain(double trace_decay) {
  return {.step_size = 0.5,
          .trace_decay = trace_decay,
          .discount = 0.5,
          .exploration = 0,
          .evaluation_exploration = 0,
          .least_trace = 0,
          .reward_scale = RewardScale::kNone};
}

}  // namespace

// Features: A has {0}, B has {0, 1}, C has {2}. One action. Rewards: 2 from A to B, 4 from B to C, 8 at the
// end. At most two features are active from B on, so that the step is 1/2 for A's update and 1/4 afterwards.
TEST_CASE("The weights of an episode of three states are those computed by hand, without traces") {
  Sarsa sarsa(plain(0), 3, 1, 1);
  sarsa.begin(active({0}));
  sarsa.next(2, active({0, 1}));  // error 2 + 0 - 0; step 1/2: w0 = 1
  CHECK(sarsa.weight(0, 0) == 1);
  sarsa.next(4, active({2}));  // error 4 + 0 - (1 + 0) = 3; step 1/4: w0 = 1.75, w1 = 0.75
  CHECK(sarsa.weight(0, 0) == 1.75);
  CHECK(sarsa.weight(1, 0) == 0.75);
  sarsa.end(8);  // error 8 - 0; w2 = 2
  CHECK(sarsa.weight(0, 0) == 1.75);
  CHECK(sarsa.weight(1, 0) == 0.75);
  CHECK(sarsa.weight(2, 0) == 2);
}

TEST_CASE("The weights of an episode of three states are those computed by hand, with traces") {
  const double decay = 0.9F * 0.5F;
  Sarsa sarsa(plain(0.9), 3, 1, 1);
  sarsa.begin(active({0}));
  sarsa.next(2, active({0, 1}));  // w0 = 1; its trace decays, and is replaced by 1
  sarsa.next(4, active({2}));     // error 3: w0 = 1.75, w1 = 0.75, both with traces of 0.45
  CHECK(sarsa.trace(0, 0) == float(decay));
  sarsa.end(8);  // error 8, step 2: w0 and w1 gain 0.9, w2 gains 2
  CHECK(sarsa.weight(0, 0) == 1.75F + 2.0F * float(decay));
  CHECK(sarsa.weight(1, 0) == 0.75F + 2.0F * float(decay));
  CHECK(sarsa.weight(2, 0) == 2);
  CHECK(sarsa.trace(0, 0) == 0);
}

TEST_CASE("A trace that is taken again is 1, and the traces of other actions are cleared or kept") {
  for (const bool clear : {true, false}) {
    SarsaSettings settings = plain(1);
    settings.discount = 1;
    settings.clear_other_traces = clear;
    Sarsa sarsa(settings, 1, 1, 2);
    const int first = sarsa.begin(active({0}));
    int second = first;
    while (second == first) second = sarsa.next(-4, active({0}));  // what was taken is worse then
    sarsa.next(-4, active({0}));
    CHECK(sarsa.trace(0, second) == 1);
    CHECK(sarsa.trace(0, first) == (clear ? 0 : 1));
  }
}

TEST_CASE("Traces below the least one are dropped") {
  SarsaSettings settings = plain(0.5);
  settings.least_trace = 0.015625;
  Sarsa sarsa(settings, 10, 1, 1);
  sarsa.begin(active({0}));
  for (std::uint32_t step = 1; step <= 3; ++step) sarsa.next(0, active({step}));
  CHECK(sarsa.trace(0, 0) == 0.015625);
  sarsa.next(0, active({4}));
  CHECK(sarsa.trace(0, 0) == 0);
}

TEST_CASE("Counts weigh features and the step, but not the traces") {
  Sarsa sarsa(plain(0), 2, 1, 1);
  sarsa.begin({{0, 1}, {3, 1}});
  sarsa.end(20);  // error 20; a step of 1 moves the value by 3 + 1, and the step size is 1/2
  CHECK(sarsa.weight(0, 0) == 2.5);
  CHECK(sarsa.weight(1, 0) == 2.5);
  CHECK(sarsa.value({{0, 1}, {2, 1}}, 0) == 7.5);
}

TEST_CASE("No update overshoots its target, whatever the counts are") {
  constexpr std::uint64_t kFeatures = 40;
  Random random(3);
  SarsaSettings settings = plain(0.9);
  settings.step_size = 1;
  Sarsa sarsa(settings, kFeatures, 1, 1);
  for (int episode = 0; episode < 300; ++episode) {
    ActiveFeatures features;
    for (std::uint32_t feature = 0; feature < kFeatures; ++feature) {
      if (random.below(3) != 0) continue;
      features.indices.push_back(feature);
      features.counts.push_back(static_cast<float>(1 + random.below(100)));
    }
    const double before = sarsa.value(features, 0), target = 1000 * (random.uniform() - 0.5);
    sarsa.begin(features);
    sarsa.end(target);
    const double way = (sarsa.value(features, 0) - before) / (target - before);
    INFO("episode " << episode);
    CHECK((features.indices.empty() || way > 0));
    CHECK((features.indices.empty() || way < 1.001));
  }
}

TEST_CASE("Counts weigh the features of 18 actions, too") {
  Sarsa sarsa(plain(0), 2, 1);
  const ActiveFeatures twice{{0}, {2}};
  const int first = sarsa.begin(twice);
  const int second = sarsa.next(8, twice);  // error 8, step 1: w0 of the first = 2
  CHECK(sarsa.weight(0, first) == 2);
  CHECK(sarsa.next(0, twice) == first);  // error 2 without the second's value, which is 4 if it is the first
  CHECK(sarsa.weight(0, second) == 0.5);
}

TEST_CASE("Rewards are divided by the size of the first one, or are signs") {
  SarsaSettings settings = plain(0);
  settings.reward_scale = RewardScale::kFirst;
  Sarsa first(settings, 2, 1, 1);
  first.begin(active({0}));
  first.next(0, active({1}));
  first.next(-200, active({0}));
  CHECK(first.weight(1, 0) == -0.5);
  first.end(400);
  CHECK(first.weight(0, 0) == 1);
  settings.reward_scale = RewardScale::kSign;
  Sarsa sign(settings, 2, 1, 1);
  sign.begin(active({0}));
  sign.next(30, active({1}));
  sign.end(-70);
  CHECK(sign.weight(0, 0) == 0.5);
  CHECK(sign.weight(1, 0) == -0.5);
}

// Sutton and Barto 1998, example 6.2, with 19 states: the value of state i is (i - 9) / 10.
TEST_CASE("The 19-state random walk approaches its values") {
  SarsaSettings settings = plain(0.9);
  settings.discount = 1;
  settings.step_size = 0.02;
  Sarsa sarsa(settings, 19, 1, 1);
  Random random(7);
  for (int episode = 0; episode < 4000; ++episode) {
    int state = 9;
    sarsa.begin(active({9}));
    while (true) {
      state += random.below(2) == 0 ? -1 : 1;
      if (state < 0 || state > 18) break;
      sarsa.next(0, active({static_cast<std::uint32_t>(state)}));
    }
    sarsa.end(state < 0 ? -1 : 1);
  }
  double squares = 0;
  for (int state = 0; state < 19; ++state)
    squares += std::pow(sarsa.weight(static_cast<std::size_t>(state), 0) - (state - 9) / 10.0, 2);
  CHECK(std::sqrt(squares / 19) < 0.1);
}

TEST_CASE("Ties are broken evenly, and exploration has its rate") {
  SarsaSettings settings = plain(0);
  settings.exploration = 0.2;
  Sarsa sarsa(settings, 1, 1, 4);
  std::array<int, 4> chosen{};
  for (int i = 0; i < 4000; ++i) ++chosen[static_cast<std::size_t>(sarsa.begin(active({0})))];
  for (const int count : chosen) CHECK(count == Approx(1000).margin(120));
  sarsa.begin(active({0}));
  sarsa.end(8);  // one action is better now
  chosen = {};
  for (int i = 0; i < 4000; ++i) ++chosen[static_cast<std::size_t>(sarsa.begin(active({0})))];
  CHECK(*std::ranges::max_element(chosen) == Approx(4000 * (0.8 + 0.05)).margin(100));
}

TEST_CASE("No learning takes place in evaluation") {
  Sarsa sarsa(plain(0.9), 2, 1, 1);
  sarsa.set_learning(false);
  sarsa.begin(active({0}));
  sarsa.next(5, active({1}));
  sarsa.end(5);
  CHECK(sarsa.weight(0, 0) == 0);
  CHECK(sarsa.weight(1, 0) == 0);
}

TEST_CASE("Weights that are not finite are noticed") {
  SarsaSettings settings = plain(0);
  settings.step_size = 100;
  Sarsa sarsa(settings, 1, 1, 1);
  sarsa.begin(active({0}));
  for (int i = 0; i < 200 && !sarsa.diverged(); ++i) sarsa.next(1e6, active({0}));
  CHECK(sarsa.diverged());
}

TEST_CASE("Weights that the last update of training made infinite are noticed in evaluation") {
  for (const double reward : {1e39, -1e39}) {
    Sarsa sarsa(plain(0), 1, 1);
    sarsa.begin(active({0}));
    sarsa.end(reward);
    sarsa.set_learning(false);
    sarsa.begin(active({0}));
    CHECK(sarsa.diverged());
  }
}

TEST_CASE("More features than traces can number are refused before memory is taken") {
  CHECK_THROWS_WITH(Sarsa(SarsaSettings(), std::size_t{1} << 40, 1),
                    "there are 1099511627776 features; a learner accepts at most 238609294");
}

TEST_CASE("A learner that was written goes on as the one that wrote it") {
  const SarsaSettings settings;
  Sarsa one(settings, 50, 1), other(settings, 50, 2);
  const auto play = [](Sarsa& sarsa, std::uint64_t seed) {
    Random random(seed);
    std::vector<int> actions{sarsa.begin(active({0}))};
    for (int i = 0; i < 200; ++i)
      actions.push_back(sarsa.next(static_cast<double>(random.below(3)),
                                   active({static_cast<std::uint32_t>(random.below(50))})));
    sarsa.end(1);
    return actions;
  };
  play(one, 5);
  StateWriter out;
  one.write(out);
  StateReader in(out.bytes());
  other.read(in);
  CHECK(in.at_end());
  CHECK(play(one, 6) == play(other, 6));
  Sarsa small(settings, 49, 1);
  StateReader again(out.bytes());
  CHECK_THROWS_AS(small.read(again), InvalidInput);
}

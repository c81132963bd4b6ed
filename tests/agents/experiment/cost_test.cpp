#include "agents/experiment/cost.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <set>

#include "agents/experiment/probe.hpp"
#include "system/invalid_input.hpp"

using namespace racebeam;

namespace {

Cost cost_with(const std::string& agent, const std::string& settings) {
  return cost_of(parse_plan(
      "games = [\"beamfall\"]\nagents = [\"" + agent + "\"]\n[agent." + agent + "]\n" + settings, ""));
}

}  // namespace

TEST_CASE("Time and memory follow the settings that change them") {
  struct Case {
    std::string agent, settings;
    double time, memory;
  };
  for (const Case& each :
       {Case{"uct", "simulations = 5000\n", 10, 10}, Case{"uct", "depth_frames = 150\n", 0.5, 1},
        Case{"full_tree", "frames = 266000\n", 2, 2}, Case{"iw1", "frames = 1500000\n", 10, 10},
        Case{"basic", "grid_width = 32\n", 2, 2}, Case{"bass", "grid_width = 32\ngrid_height = 42\n", 36, 36},
        Case{"lsh", "vectors = 4000\n", 2, 2}, Case{"lsh", "buckets = 100\n", 1, 1.5},
        Case{"disco", "tilings = 16\ngrid = 16\n", 2, 32}, Case{"ram", "alpha = 0.1\n", 1, 1}}) {
    INFO(each.agent << " " << each.settings);
    const Cost default_cost = cost_with(each.agent, ""), cost = cost_with(each.agent, each.settings);
    CHECK(cost.core_hours / default_cost.core_hours == Approx(each.time));
    CHECK(cost.megabytes / default_cost.megabytes == Approx(each.memory));
  }
  CHECK(cost_with("uct", "simulations = 1\n").megabytes == 2);  // of the machine
}

TEST_CASE("Disk counts blocks of logs, and rows of all tables") {
  const auto disk = [](const std::string& settings) {
    return cost_with("basic", "trials = 1\n" + settings).disk_megabytes;
  };
  const double least = disk("training_episodes = 0\nevaluation_episodes = 1\n");
  CHECK(disk("training_episodes = 0\nevaluation_episodes = 1001\n") - least ==
        Approx(1000 * (4096 + 400) / 1e6));
  CHECK(disk("training_episodes = 1000\nevaluation_episodes = 1\n") - least == Approx(1000 * 120 / 1e6));
}

TEST_CASE("A plan that takes more memory than there is is refused") {
  const Plan plan = parse_plan("games = [\"beamfall\"]\nagents = [\"random\", \"bass\"]\n", "");
  const Allowance gigabyte{1000000000, "the control group"};
  CHECK_NOTHROW(check_memory(plan, 2, gigabyte));
  CHECK_THROWS_WITH(
      check_memory(plan, 3, gigabyte),
      "the plan takes about 1090 MB of memory: 340 MB for bass on each of 3 threads; the control "
      "group allows 1000 MB; accepted: fewer --threads, or settings that take less");
  const Plan large = parse_plan(
      "games = [\"beamfall\"]\nagents = [\"bass\"]\n[agent.bass]\ntrials = 1\ngrid_width = 160\ngrid_height "
      "= "
      "210\n",
      "");
  CHECK_THROWS_WITH(check_memory(large, 8, gigabyte), Catch::Contains("for bass on each of 1 threads"));
}

TEST_CASE("What was measured decides, and games that were not measured get the mean of the others") {
  const Plan plan = parse_plan(
      "games = [\"beamfall\", \"updraft\", \"pong\"]\nagents = [\"basic\", \"uct\"]\n[agent.basic]\ntrials = "
      "2\ntraining_episodes = 9\nevaluation_episodes = 1\n",
      "");
  PlayRates rates;
  CHECK(rates.empty());
  const PlanAgent &basic = plan.agents[0], &uct = plan.agents[1];
  rates.add(plan.games[0], basic,
            {.episode_frames = 1000, .decisions_per_second = 100, .discovery_seconds = 3600});
  rates.add(plan.games[1], basic, {.episode_frames = 3000, .decisions_per_second = 50});
  CHECK(rates.games() == 2);
  CHECK(seconds_of_trial(basic, rates.of(plan, plan.games[0], basic)) == Approx(10 * 1000 / 5 / 100.0));
  const PlayRate mean = rates.of(plan, plan.games[2], basic);
  CHECK(mean.episode_frames == Approx(2000));
  CHECK(1 / mean.decisions_per_second == Approx((0.01 + 0.02) / 2));
  CHECK(rates.of(plan, plan.games[0], uct).episode_frames == 18000);
  CHECK(rates.of(plan, plan.games[0], uct).decisions_per_second == uct.kind->decisions_per_second);
  const Cost cost = cost_of(plan, rates);
  CHECK(cost.discovery_core_hours == Approx(1 + 0 + 0.5));
  CHECK(cost.agents[0].decisions == Approx(2 * 10 * (1000 + 3000 + 2000) / 5));
  CHECK(cost.core_hours ==
        Approx(cost.agents[0].core_hours + cost.agents[1].core_hours + cost.discovery_core_hours));
}

TEST_CASE("A moment of play measures every kind of agent") {
  std::string names;
  for (const AgentKind& kind : agent_kinds())
    names += (names.empty() ? "\"" : ", \"") + std::string(kind.name) + '"';
  Plan plan = parse_plan(
      "games = [\"beamfall\"]\nbackground_screens = 2000\nclass_screens = 2000\nagents = [" + names +
          "]\n[agent.full_tree]\nframes = 500\n[agent.iw1]\nframes = 500\n[agent.rollout_iw1]\nframes = "
          "500\n[agent.uct]\nsimulations = 5\n",
      "");
  const auto measured = [&plan](int seconds) {
    return measure_rates(plan, Images(), std::chrono::duration<double>(seconds));
  };
  const auto random_frames = [&plan](const PlayRates& of) {
    return of.of(plan, plan.games[0], plan.agents[0]).episode_frames;
  };
  PlayRates rates = measured(1);
  if (random_frames(rates) >= 9000) rates = measured(20);  // with sanitizers, no episode may end before
  std::set<double> lengths;
  for (const PlanAgent& agent : plan.agents) {
    INFO(agent.kind->name);
    const PlayRate rate = rates.of(plan, plan.games[0], agent);
    CHECK(rate.decisions_per_second > 1);
    CHECK(rate.decisions_per_second != agent.kind->decisions_per_second);
    CHECK(rate.episode_frames >= agent.frame_skip);
    CHECK(rate.episode_frames <= 18000);
    if (agent.kind->role == Role::kLearner) lengths.insert(rate.episode_frames);
    if (agent.kind->role == Role::kPlanner) CHECK(rate.episode_frames == 18000);
  }
  CHECK(lengths.size() == 1);  // which all learners of a game share
  CHECK(random_frames(rates) < 9000);
}

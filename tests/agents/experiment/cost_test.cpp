#include "agents/experiment/cost.hpp"

#include <catch2/catch.hpp>

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
    const Cost usual = cost_with(each.agent, ""), cost = cost_with(each.agent, each.settings);
    CHECK(cost.core_hours / usual.core_hours == Approx(each.time));
    CHECK(cost.megabytes / usual.megabytes == Approx(each.memory));
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
      "group allows 1000 MB; accepted are fewer --threads, or settings that take less");
  const Plan large = parse_plan(
      "games = [\"beamfall\"]\nagents = [\"bass\"]\n[agent.bass]\ntrials = 1\ngrid_width = 160\ngrid_height "
      "= "
      "210\n",
      "");
  CHECK_THROWS_WITH(check_memory(large, 8, gigabyte), Catch::Contains("for bass on each of 1 threads"));
}

// Every setting that a plan can give an agent reaches it.
#include <catch2/catch.hpp>
#include <map>

#include "tests/agents/experiment/samples.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

// Every score, length and final state of training and evaluation, as the tables have them.
std::string tables_of(const std::string& agent, const std::string& environment, const std::string& settings) {
  const Scratch place;
  const ResultsFolder folder(place.path("results"));
  run(bound_plan("games = [\"beamfall\"]\nagents = [\"" + agent +
                 "\"]\nbackground_screens = 100\nclass_screens = 300\nenvironment = \"max_episode_frames=" +
                 (find_agent_kind(agent)->role == Role::kPlanner ? "300 " : "1000 ") + environment +
                 "\"\n[agent." + agent + "]\ntrials = 1\n" + settings),
      folder);
  return contents(folder.results()) + contents(folder.curves());
}

struct Case {
  std::string agent;
  std::string usual;                           // lengths, and settings that all runs have
  std::map<std::string, std::string> changed;  // a setting and its other value
};

constexpr auto kLength = "training_episodes = 6\nevaluation_episodes = 2\n";

// Settings of SARSA are the same for all learners. Settings that rarely change a choice have extreme values.
const std::vector<Case> kCases = {
    {"perturb", "evaluation_episodes = 1\n", {{"probability", "0.5"}}},
    {"basic",
     kLength,
     {{"alpha", "0.1"},
      {"lambda", "0.2"},
      {"gamma", "0.5"},
      {"epsilon", "0.3"},
      {"evaluation_epsilon", "0"},
      {"least_trace", "0.9"},
      {"clear_other_traces", "1"},
      {"reward_scale", "\"sign\""},
      {"grid_width", "8"},
      {"grid_height", "7"}}},
    {"disco", kLength, {{"tilings", "2"}, {"grid", "3"}, {"count_instances", "0"}}},
    {"lsh", kLength, {{"vectors", "2"}, {"ones", "2000"}, {"buckets", "2"}}},
    {"blob_prost",
     std::string(kLength) + "clear_other_traces = 1\n",
     {{"blob_distance", "210"}, {"most_features", "50"}}},
    {"full_tree", "frames = 400\n", {{"frames", "2000"}, {"reuse_tree", "1"}}},
    {"iw1",
     "frames = 1000\n",
     {{"frames", "300"}, {"gamma", "0.1"}, {"reuse_tree", "0"}, {"reward_aside", "0"}}},
    {"iw1", "frames = 10000\n", {{"limit_branches", "1"}, {"reward_aside", "2"}}},
    {"rollout_iw1", "frames = 1500\n", {{"frames", "300"}, {"gamma", "0.1"}, {"reuse_tree", "0"}}},
    {"uct",
     "simulations = 20\n",
     {{"simulations", "10"},
      {"depth_frames", "50"},
      {"exploration", "3"},
      {"gamma", "0.1"},
      {"merge_duplicates", "0"},
      {"reward_scale", "\"sign\""}}},
};

}  // namespace

TEST_CASE("Every setting of an agent makes a difference") {
  for (const Case& each : kCases) {
    const std::string tables = tables_of(each.agent, "", each.usual);
    for (const auto& [setting, value] : each.changed) {
      INFO(each.agent << ": " << setting << " = " << value);
      std::string settings = each.usual;
      if (const std::size_t at = settings.find(setting + " ="); at != std::string::npos)
        settings.erase(at, settings.find('\n', at) + 1 - at);
      CHECK(tables_of(each.agent, "", settings + setting + " = " + value + "\n") != tables);
    }
  }
}

TEST_CASE("Averaged colours make a difference, with traces that are cleared, too") {
  const std::string cleared = std::string(kLength) + "clear_other_traces = 1\n";
  for (const std::string& settings : {std::string(kLength), cleared})
    CHECK(tables_of("basic", "color_averaging=1", settings) != tables_of("basic", "", settings));
}

TEST_CASE("Each setting in the table of agents is one that a test changes") {
  for (const Case& each : kCases)
    for (const AgentSetting& setting : find_agent_kind(each.agent)->settings) {
      INFO(each.agent << ": " << setting.name);
      const auto is_covered = [&](const Case& other) {
        return other.changed.contains(std::string(setting.name));
      };
      CHECK(std::ranges::any_of(kCases, is_covered));
    }
}

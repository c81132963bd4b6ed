// Estimates the cost of a plan from measured speeds and lengths of episodes.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "agents/experiment/plan.hpp"
#include "system/resources.hpp"

namespace racebeam {

constexpr double kProgramMegabytes = 70;  // with 104 images, measured

// How fast an agent plays a game.
struct PlayRate {
  double episode_frames = 0;  // the mean length of an episode
  double decisions_per_second = 0;
  double discovery_seconds = 0;  // of the game's background and classes
};

// Measured rates, by agent and game; empty at first.
class PlayRates {
 public:
  void add(const PlanGame& game, const PlanAgent& agent, const PlayRate& rate);
  bool empty() const { return rates_.empty(); }
  std::size_t games() const;  // how many games have a rate

  // Returns the agent's rate in this game; otherwise the mean of its rates in other games; otherwise that of
  // the table of agents, with episodes as long as the plan allows.
  PlayRate of(const Plan& plan, const PlanGame& game, const PlanAgent& agent) const;

 private:
  std::map<std::string, std::map<std::string, PlayRate>, std::less<>> rates_;  // by agent, then by game
};

struct AgentCost {
  std::string agent;
  std::size_t units = 0;
  double decisions = 0;
  double core_hours = 0;
};

struct Cost {
  std::vector<AgentCost> agents;
  std::size_t units = 0;
  double decisions = 0, core_hours = 0, verification_core_hours = 0;
  double discovery_core_hours = 0;  // included in core_hours
  double megabytes = 0;             // the most that a unit takes, beside the program
  double disk_megabytes = 0;        // of logs and tables
};

// Frames of one trial, if each episode has `episode_frames`.
struct TrialFrames {
  double training = 0, evaluation = 0;
};
TrialFrames frames_of_trial(const TrialLength& length, double episode_frames);

// Processor time of one trial, in seconds, as cost_of() counts it.
double seconds_of_trial(const PlanAgent& agent, const PlayRate& rate);

// Estimates the cost of a plan. Without rates, it assumes that episodes are as long as the plan allows, so
// that the result is an upper bound.
Cost cost_of(const Plan& plan, const PlayRates& rates = {});

// Throws InvalidInput if this many threads are expected to take more than `bytes` of memory.
void check_memory(const Plan& plan, unsigned threads, const Allowance& bytes);

}  // namespace racebeam

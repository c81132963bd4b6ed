// What a plan is expected to cost, from speeds and lengths of episodes that were measured.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "agents/experiment/plan.hpp"
#include "system/resources.hpp"

namespace racebeam {

constexpr double kProgramMegabytes = 70;  // with 104 images, measured

// How an agent plays a game.
struct PlayRate {
  double episode_frames = 0;  // of an episode, in the mean
  double decisions_per_second = 0;
  double discovery_seconds = 0;  // of the game's background and classes
};

// What was measured, by game and agent; nothing yet.
class PlayRates {
 public:
  void add(const PlanGame& game, const PlanAgent& agent, const PlayRate& rate);
  bool empty() const { return rates_.empty(); }
  std::size_t games() const;  // that were measured

  // That of the game; else the mean of the agent's other games; else that of the table, with episodes as long
  // as they may be.
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
  double discovery_core_hours = 0;  // among core_hours
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

// Without rates, episodes are taken to be as long as they may be, so that this is the most.
Cost cost_of(const Plan& plan, const PlayRates& rates = {});

// Throws InvalidInput if this many threads are expected to take more than `bytes` of memory.
void check_memory(const Plan& plan, unsigned threads, const Allowance& bytes);

}  // namespace racebeam

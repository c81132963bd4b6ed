// What a plan is expected to cost, from speeds that were measured.
#pragma once

#include <string>
#include <vector>

#include "agents/experiment/plan.hpp"
#include "system/resources.hpp"

namespace racebeam {

constexpr double kProgramMegabytes = 70;  // with 104 images, measured

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
  double megabytes = 0;       // the most that a unit takes, beside the program
  double disk_megabytes = 0;  // of logs and tables
};

// Frames of one trial, if each episode is as long as it may be.
struct TrialFrames {
  double training = 0, evaluation = 0;
};
TrialFrames frames_of_trial(const TrialLength& length, int episode_frames);

// Processor time of one trial, in seconds, as cost_of() counts it.
double seconds_of_trial(const Plan& plan, const PlanAgent& agent);

// Episodes are taken to be as long as they may be, so that this is the most.
Cost cost_of(const Plan& plan);

// Throws InvalidInput if so many threads are expected to take more than `bytes` of memory.
void check_memory(const Plan& plan, unsigned threads, const Allowance& bytes);

}  // namespace racebeam

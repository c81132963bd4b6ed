#include "agents/experiment/cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr double kReplayFramesPerSecond = 120000;  // of one core, measured
constexpr double kLogBytesPerDecision = 0.55;      // a random action has log2(18) bits
// A file takes whole blocks. Rows are in a table of their unit, and in one of all units.
constexpr double kBlockBytes = 4096, kFilesOfUnit = 4, kResultBytes = 2 * 200, kCurveBytes = 2 * 60;
constexpr double kMachineMegabytes = 2;  // of a trial, whatever its settings; measured

Effort effort_of(const PlanAgent& agent) {
  return agent.kind->effort ? agent.kind->effort(agent.values) : Effort{};
}

double megabytes_of(const PlanAgent& agent) {
  return std::max(agent.kind->megabytes * effort_of(agent).memory, kMachineMegabytes);
}

double disk_bytes_of_trial(const Plan& plan, const PlanAgent& agent) {
  const double frames = plan.play.machine.max_episode_frames;
  const double log = std::ceil(frames / agent.frame_skip * kLogBytesPerDecision / kBlockBytes) * kBlockBytes;
  return kFilesOfUnit * kBlockBytes + agent.length.evaluation_episodes * (log + kResultBytes) +
         frames_of_trial(agent.length, plan.play.machine.max_episode_frames).training / frames * kCurveBytes;
}

std::string whole_number(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", number);
  return text;
}

}  // namespace

TrialFrames frames_of_trial(const TrialLength& length, int episode_frames) {
  const double frames = episode_frames;
  return {.training = length.training_frames > 0 ? length.training_frames : length.training_episodes * frames,
          .evaluation = length.evaluation_episodes * frames};
}

double seconds_of_trial(const Plan& plan, const PlanAgent& agent) {
  const TrialFrames frames = frames_of_trial(agent.length, plan.play.machine.max_episode_frames);
  return (frames.training + frames.evaluation) / agent.frame_skip / agent.kind->decisions_per_second *
         effort_of(agent).time;
}

Cost cost_of(const Plan& plan) {
  Cost cost;
  for (const PlanAgent& agent : plan.agents) {
    const TrialLength& length = agent.length;
    AgentCost own{.agent = std::string(agent.kind->name)};
    own.units = plan.games.size() * static_cast<std::size_t>(length.trials) *
                (agent.kind->each_action ? kActions : 1);
    const auto units = static_cast<double>(own.units);
    const TrialFrames frames = frames_of_trial(length, plan.play.machine.max_episode_frames);
    const double evaluation = units * frames.evaluation;
    own.decisions = (evaluation + units * frames.training) / agent.frame_skip;
    own.core_hours = units * seconds_of_trial(plan, agent) / 3600;
    cost.units += own.units;
    cost.decisions += own.decisions;
    cost.core_hours += own.core_hours;
    cost.verification_core_hours += evaluation / kReplayFramesPerSecond / 3600;
    cost.megabytes = std::max(cost.megabytes, megabytes_of(agent));
    cost.disk_megabytes += units * disk_bytes_of_trial(plan, agent) / 1e6;
    cost.agents.push_back(own);
  }
  return cost;
}

void check_memory(const Plan& plan, unsigned threads, const Allowance& bytes) {
  const auto most = std::ranges::max_element(plan.agents, {}, megabytes_of);
  const double each = megabytes_of(*most), usable = static_cast<double>(bytes.amount) / 1e6;
  const auto busy = std::min<std::size_t>(threads, cost_of(plan).units);
  const double needed = kProgramMegabytes + static_cast<double>(busy) * each;
  if (needed <= usable) return;
  throw InvalidInput("the plan takes about " + whole_number(needed) + " MB of memory: " + whole_number(each) +
                     " MB for " + std::string(most->kind->name) + " on each of " + std::to_string(busy) +
                     " threads; " + bytes.limited_by + " allows " + whole_number(usable) +
                     " MB; accepted are fewer --threads, or settings that take less");
}

}  // namespace racebeam

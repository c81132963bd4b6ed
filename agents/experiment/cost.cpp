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

double disk_bytes_of_trial(const PlanAgent& agent, double episode_frames) {
  const double bytes = episode_frames / agent.frame_skip * kLogBytesPerDecision;
  const double log = std::ceil(bytes / kBlockBytes) * kBlockBytes;
  return kFilesOfUnit * kBlockBytes + agent.length.evaluation_episodes * (log + kResultBytes) +
         frames_of_trial(agent.length, episode_frames).training / episode_frames * kCurveBytes;
}

std::string whole_number(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f", number);
  return text;
}

}  // namespace

void PlayRates::add(const PlanGame& game, const PlanAgent& agent, const PlayRate& rate) {
  rates_[std::string(agent.kind->name)][game.name] = rate;
}

std::size_t PlayRates::games() const {
  std::size_t most = 0;
  for (const auto& [agent, games] : rates_) most = std::max(most, games.size());
  return most;
}

PlayRate PlayRates::of(const Plan& plan, const PlanGame& game, const PlanAgent& agent) const {
  const auto found = rates_.find(agent.kind->name);
  if (found == rates_.end())
    return {.episode_frames = static_cast<double>(plan.play.machine.max_episode_frames),
            .decisions_per_second = agent.kind->decisions_per_second / effort_of(agent).time};
  const std::map<std::string, PlayRate>& games = found->second;
  if (const auto own = games.find(game.name); own != games.end()) return own->second;
  const auto count = static_cast<double>(games.size());
  PlayRate mean;
  double seconds_per_decision = 0;
  for (const auto& [name, rate] : games) {
    mean.episode_frames += rate.episode_frames / count;
    mean.discovery_seconds += rate.discovery_seconds / count;
    seconds_per_decision += 1 / rate.decisions_per_second / count;
  }
  mean.decisions_per_second = 1 / seconds_per_decision;
  return mean;
}

TrialFrames frames_of_trial(const TrialLength& length, double episode_frames) {
  return {.training =
              length.training_frames > 0 ? length.training_frames : length.training_episodes * episode_frames,
          .evaluation = length.evaluation_episodes * episode_frames};
}

double seconds_of_trial(const PlanAgent& agent, const PlayRate& rate) {
  const TrialFrames frames = frames_of_trial(agent.length, rate.episode_frames);
  return (frames.training + frames.evaluation) / agent.frame_skip / rate.decisions_per_second;
}

namespace {

// Adds the agent's units in one game.
void add_game(Cost& cost, AgentCost& own, const Plan& plan, const PlanGame& game, const PlanAgent& agent,
              const PlayRate& rate) {
  const std::size_t count =
      actions_of_agents(game, *agent.kind).size() * static_cast<std::size_t>(agent.length.trials);
  const auto units = static_cast<double>(count);
  const TrialFrames frames = frames_of_trial(agent.length, rate.episode_frames);
  own.units += count;
  own.decisions += units * (frames.training + frames.evaluation) / agent.frame_skip;
  own.core_hours += units * seconds_of_trial(agent, rate) / 3600;
  cost.verification_core_hours += units * frames.evaluation / kReplayFramesPerSecond / 3600;
  // Logs are counted as the longest, since disks that are full end a run.
  cost.disk_megabytes += units * disk_bytes_of_trial(agent, plan.play.machine.max_episode_frames) / 1e6;
}

}  // namespace

Cost cost_of(const Plan& plan, const PlayRates& rates) {
  Cost cost;
  for (const PlanAgent& agent : plan.agents) {
    AgentCost own{.agent = std::string(agent.kind->name)};
    for (const PlanGame& game : plan.games)
      add_game(cost, own, plan, game, agent, rates.of(plan, game, agent));
    cost.units += own.units;
    cost.decisions += own.decisions;
    cost.core_hours += own.core_hours;
    cost.megabytes = std::max(cost.megabytes, megabytes_of(agent));
    cost.agents.push_back(own);
  }
  for (const PlanGame& game : plan.games) {
    double seconds = 0;  // agents share what was discovered
    for (const PlanAgent& agent : plan.agents)
      seconds = std::max(seconds, rates.of(plan, game, agent).discovery_seconds);
    cost.discovery_core_hours += seconds / 3600;
  }
  cost.core_hours += cost.discovery_core_hours;
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
                     " MB; accepted: fewer --threads, or settings that take less");
}

}  // namespace racebeam

// Runs a plan into a folder of results, on several threads and in several processes (docs/experiments.md).
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "agents/experiment/plan.hpp"
#include "agents/experiment/results.hpp"
#include "games/images.hpp"

namespace racebeam {

struct ExperimentSettings {
  unsigned threads = 1;
  std::size_t shard = 1, shards = 1;  // this process runs each shards-th unit, from the shard-th on
  std::chrono::milliseconds checkpoints{60000};  // the least time between two
  CpuKind cpu = CpuKind::kAuto;
  std::chrono::milliseconds reports{0};  // between two within a unit; 0: only finished units are reported
  // Called after each decision, by all threads. An exception of it ends the run.
  std::function<void()> check = {};
};

// How far an experiment has come.
struct Progress {
  // Units that were not finished when this process began. Other processes finish some of them.
  std::size_t finished = 0, all = 0;
  std::string unit;
  bool unit_finished = false;
  int episodes = 0;            // of the unit: of evaluation if it is finished, else all that are over
  std::int64_t decisions = 0;  // of the episode that is played
  double mean_score = 0;       // of a unit that is finished
  // Both follow from the time that the work so far took. Measured speeds say how much work a unit is.
  std::chrono::duration<double> elapsed{}, left{};
};
using ProgressCallback = std::function<void(const Progress& progress)>;  // called by one thread at a time

// Runs the units of a plan that bind() has completed. It skips units that are finished, and continues those
// that have begun. Whatever ends the run, finished units stay, and are in the tables. Throws InvalidInput,
// before it writes anything, for a folder that has another plan, or backgrounds or classes of one. Throws
// std::runtime_error if another process is still running units, or a file cannot be written.
void run_experiment(const Plan& plan, const Images& images, const ResultsFolder& folder,
                    const ExperimentSettings& settings, const ProgressCallback& report);

}  // namespace racebeam

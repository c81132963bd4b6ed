// Runs a plan into a folder of results, on several threads and in several processes (docs/experiments.md).
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "agents/experiment/plan.hpp"
#include "agents/experiment/results.hpp"
#include "protocol/line/images.hpp"

namespace racebeam {

struct ExperimentSettings {
  unsigned threads = 1;
  std::size_t shard = 1, shards = 1;  // this process runs each shards-th unit, from the shard-th on
  std::chrono::milliseconds checkpoints{60000};  // at least so much time between two
  CpuKind cpu = CpuKind::kAuto;
};

// Where an experiment is.
struct Progress {
  std::size_t finished = 0, all = 0;  // units of this process
  std::string unit;                   // that was finished last
  int episodes = 0;
  double mean_score = 0;
  std::chrono::duration<double> elapsed{}, left{};  // by the time that the finished units took
};
using Report = std::function<void(const Progress& progress)>;  // from one thread at a time

// `plan` is bound. Finished units are not run again, and unfinished ones go on. Throws InvalidInput for a
// folder of another plan, and std::runtime_error when units are run by another process, or when a file cannot
// be written; what is finished stays.
void run_experiment(const Plan& plan, const Images& images, const ResultsFolder& folder,
                    const ExperimentSettings& settings, const Report& report);

}  // namespace racebeam

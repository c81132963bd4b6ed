// Measures how fast many machines run together (environment/vector/batch.hpp).
#pragma once

#include <nlohmann/json.hpp>

#include "cli/arguments/options.hpp"

namespace racebeam {

struct BatchBenchOptions {
  int machines = 0;  // 0: do not measure a batch
  int threads = 0;   // 0: one for each processor
  bool same_step = false;
};

// Steps a batch of the cartridge until its machines have run about `frames` frames in all. `actions` are
// indices into the action set. The machines take them in turn, again and again; if empty, actions are random.
nlohmann::ordered_json time_batch(const Cartridge& cartridge, const MachineOptions& machine,
                                  const BatchBenchOptions& options, int frames,
                                  const std::vector<int>& actions);

}  // namespace racebeam

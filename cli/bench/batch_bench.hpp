// How fast many machines run together: environment/vector/batch.hpp.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/arguments/options.hpp"

namespace racebeam {

struct BatchBenchOptions {
  int machines = 0;  // 0: no batch is measured
  int threads = 0;   // 0: one for each processor
  bool same_step = false;
};

// Steps a batch of the cartridge until its machines have run about `frames` frames in all. `actions` are
// indices, dealt out step by step, machine by machine, over and over; when empty, they are drawn.
nlohmann::ordered_json time_batch(const Cartridge& cartridge, const MachineOptions& machine,
                                  const BatchBenchOptions& options, int frames,
                                  const std::vector<int>& actions);

}  // namespace racebeam

// How long a planner waits: environment/vector/branch.hpp.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/arguments/options.hpp"

namespace racebeam {

// Plays 500 random branches of 300 frames from one state in the middle of a game, with the frame skip of
// `options`, looking at rewards and ends alone.
nlohmann::ordered_json time_search(const Cartridge& cartridge, const MachineOptions& options);

}  // namespace racebeam

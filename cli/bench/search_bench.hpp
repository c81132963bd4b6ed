// Measures the work of a planner: environment/vector/branch.hpp.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/arguments/options.hpp"

namespace racebeam {

// Plays 500 random branches of 300 frames from one state in the middle of a game, with the frame skip of
// `options`. Only rewards and ends are observed.
nlohmann::ordered_json time_search(const Cartridge& cartridge, const MachineOptions& options);

}  // namespace racebeam

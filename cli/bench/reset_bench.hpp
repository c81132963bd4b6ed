// Measures resets, and whether they are copies.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/arguments/options.hpp"

namespace racebeam {

// Plays 50 random frames before each of `resets` resets. Before them, it runs as many that are not timed.
nlohmann::ordered_json time_resets(const Cartridge& cartridge, const MachineOptions& options, int resets);

}  // namespace racebeam

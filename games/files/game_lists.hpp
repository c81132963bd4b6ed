// Reads the lists of a game file: actions, modes and difficulties.
#pragma once

#include <string_view>
#include <vector>

#include "games/files/toml_section.hpp"

namespace racebeam {

// Names of player A's actions, as ascending numbers; `otherwise` if the key is absent.
std::vector<int> read_actions(const Section& section, std::string_view key, std::vector<int> otherwise);

// From "FIRE", "NOOP 60" and so on: one number for each frame.
std::vector<int> read_starting_actions(const Section& section, std::string_view key);

// Numbers and ranges "0-7", none above `largest`; only 0 if the key is absent.
std::vector<int> read_numbers(const Section& section, std::string_view key, int largest);

}  // namespace racebeam

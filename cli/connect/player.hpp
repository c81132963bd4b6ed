// A person plays in the terminal.
#pragma once

#include <string>

#include "cli/terminal/graphics.hpp"

namespace racebeam {

// Loads the game in a session of the server at `address`, and plays until the person ends it. Throws
// std::exception if the terminal, the server or the game is missing.
void play_in_terminal(const std::string& address, const std::string& game, Graphics graphics);

}  // namespace racebeam

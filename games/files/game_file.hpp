// Reads a game file (games/catalogue/README.md describes the format).
#pragma once

#include <string>
#include <string_view>

#include "games/game/game.hpp"

namespace racebeam {

// `file` is the name for errors. Throws InvalidInput: "FILE:LINE: FIELD: sentence".
Game parse_game(std::string_view text, const std::string& name, const std::string& file);

}  // namespace racebeam

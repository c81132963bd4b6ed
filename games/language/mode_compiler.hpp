// Compiles mode programs (games/catalogue/README.md, "`[mode]`").
#pragma once

#include <string_view>

#include "games/game/mode_program.hpp"
#include "games/language/variable_names.hpp"

namespace racebeam {

// names: the variables of the game's rule. Throws SourceError.
ModeProgram compile_mode_program(std::string_view source, VariableNames& names);

}  // namespace racebeam

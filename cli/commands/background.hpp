// racebeam background: discovers the still part of a game's screen.
#pragma once

namespace racebeam {

class Subcommand;

void add_background(Subcommand& program);

}  // namespace racebeam

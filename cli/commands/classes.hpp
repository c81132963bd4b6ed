// racebeam classes: discovers the classes of objects in a game.
#pragma once

namespace racebeam {

class Subcommand;

void add_classes(Subcommand& program);

}  // namespace racebeam

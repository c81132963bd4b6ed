// racebeam png: converts a screen, as a client received it, to a picture.
#pragma once

namespace racebeam {

class Subcommand;

void add_png(Subcommand& program);

}  // namespace racebeam

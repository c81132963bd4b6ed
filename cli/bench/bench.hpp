// racebeam bench: measures how fast a game runs.
#pragma once

namespace racebeam {

class Subcommand;

void add_bench(Subcommand& program);

}  // namespace racebeam

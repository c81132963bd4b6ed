// racebeam experiment: runs agents on games, as a plan says.
#pragma once

namespace racebeam {

class Subcommand;

void add_experiment(Subcommand& program);

}  // namespace racebeam

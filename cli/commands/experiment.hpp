// racebeam experiment: runs agents on games, as a plan says.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_experiment(CLI::App& app);

}  // namespace racebeam

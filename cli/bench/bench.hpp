// racebeam bench: measures how fast a game runs.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_bench(CLI::App& app);

}  // namespace racebeam

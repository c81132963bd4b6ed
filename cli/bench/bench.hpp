// racebeam bench: how fast a game runs, and what was produced meanwhile.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_bench(CLI::App& app);

}  // namespace racebeam

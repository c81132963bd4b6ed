// racebeam with: a server for as long as a command runs.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_with(CLI::App& app);

}  // namespace racebeam

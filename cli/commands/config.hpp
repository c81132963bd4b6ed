// racebeam config: shows the settings of a server, and their sources.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_config(CLI::App& app);

}  // namespace racebeam

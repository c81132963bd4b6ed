// racebeam config: the settings of a server, and where each comes from.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_config(CLI::App& app);

}  // namespace racebeam

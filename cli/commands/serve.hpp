// racebeam serve: a machine for each client.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_serve(CLI::App& app);

}  // namespace racebeam

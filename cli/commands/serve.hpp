// racebeam serve: a machine for every client that asks.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_serve(CLI::App& app);

}  // namespace racebeam

// racebeam background: discovers the still part of a game's screen.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_background(CLI::App& app);

}  // namespace racebeam

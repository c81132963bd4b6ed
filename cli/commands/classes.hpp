// racebeam classes: discovers the classes of objects in a game.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_classes(CLI::App& app);

}  // namespace racebeam

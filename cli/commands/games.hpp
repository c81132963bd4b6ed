// racebeam games: lists the catalogue.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_games(CLI::App& app);

}  // namespace racebeam

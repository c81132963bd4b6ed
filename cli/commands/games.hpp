// racebeam games: lists the catalogue.
#pragma once

namespace racebeam {

class Subcommand;

void add_games(Subcommand& program);

}  // namespace racebeam

// racebeam with: a server for as long as a command runs.
#pragma once

namespace racebeam {

class Subcommand;

void add_with(Subcommand& program);

}  // namespace racebeam

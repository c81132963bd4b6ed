// racebeam config: shows the settings of a server, and their sources.
#pragma once

namespace racebeam {

class Subcommand;

void add_config(Subcommand& program);

}  // namespace racebeam

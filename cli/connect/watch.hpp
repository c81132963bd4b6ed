// racebeam watch: looks at the shared sessions of a server.
#pragma once

namespace racebeam {

class Subcommand;

void add_watch(Subcommand& program);

}  // namespace racebeam

// racebeam connect: a person or a script talks to a server of the line protocol.
#pragma once

namespace racebeam {

class Subcommand;

void add_connect(Subcommand& program);

}  // namespace racebeam

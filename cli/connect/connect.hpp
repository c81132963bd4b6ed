// racebeam connect: a person or a script talks to a server of the line protocol.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_connect(CLI::App& app);

}  // namespace racebeam

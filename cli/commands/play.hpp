// racebeam play: a server on this machine, and its page in a browser, or a game in the terminal.
#pragma once

namespace racebeam {

class Subcommand;

void add_play(Subcommand& program);

}  // namespace racebeam

// racebeam render: makes a film or pictures of the log of an episode.
#pragma once

namespace racebeam {

class Subcommand;

void add_render(Subcommand& program);

}  // namespace racebeam

// racebeam classic: accepts the command line of ALE 0.4 to 0.6, so that an old launcher works with this
// program.
#pragma once

namespace racebeam {

class Subcommand;

void add_classic(Subcommand& program);

}  // namespace racebeam

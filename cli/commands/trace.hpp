// racebeam trace: prints the results of a list of actions, act by act, as checksums that can be compared.
#pragma once

namespace racebeam {

class Subcommand;

void add_trace(Subcommand& program);

}  // namespace racebeam

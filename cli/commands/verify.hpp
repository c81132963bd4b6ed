// racebeam verify: plays the logs of an experiment again, and confirms its scores.
#pragma once

namespace racebeam {

class Subcommand;

void add_verify(Subcommand& program);

}  // namespace racebeam

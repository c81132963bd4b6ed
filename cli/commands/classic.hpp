// racebeam classic: takes the command line of ALE 0.4-0.6, so that an old launcher works when pointed at our
// binary.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_classic(CLI::App& app);

}  // namespace racebeam

// racebeam trace: prints the results of a list of actions, act by act, as checksums that can be compared.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_trace(CLI::App& app);

}  // namespace racebeam

// racebeam trace: what a list of actions leads to, act by act, as checksums that can be compared.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_trace(CLI::App& app);

}  // namespace racebeam

// racebeam verify: plays the logs of an experiment again, and confirms its scores.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_verify(CLI::App& app);

}  // namespace racebeam

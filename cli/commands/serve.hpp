// racebeam serve: a machine for each client.
#pragma once

#include <vector>

namespace racebeam {

class Subcommand;

struct ServeOptions;
struct Setting;

void add_serve(Subcommand& program);

// Serves until the end. `settings`: from complete(), after which `options` may be changed. Returns the exit
// status; the reason of a failure has been written. Throws for settings that do not fit together.
int run_server(ServeOptions& options, const std::vector<Setting>& settings);

}  // namespace racebeam

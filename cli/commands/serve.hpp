// racebeam serve: a machine for each client.
#pragma once

#include <vector>

#include "protocol/line/images.hpp"

namespace racebeam {

class Subcommand;

struct ServeOptions;
struct Setting;

void add_serve(Subcommand& program);

// The built-in images, and those of --rom and --roms. Throws std::invalid_argument if one of the
// two cannot be read.
Images offered_images(const ServeOptions& options);

// Serves until the end. `settings`: from complete(), after which `options` may be changed. Returns the exit
// status; the reason of a failure has been written. Throws for settings that do not fit together.
int run_server(ServeOptions& options, const std::vector<Setting>& settings);

}  // namespace racebeam

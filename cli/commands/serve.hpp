// racebeam serve: a machine for each client.
#pragma once

#include <string>
#include <vector>

#include "games/images.hpp"

namespace racebeam {

class Subcommand;

struct ServeOptions;
struct Setting;

void add_serve(Subcommand& program);

// The built-in images, and those of --rom and --roms. Throws InvalidInput if one of the two cannot be read,
// or if --game-file has the rules of none of them.
Images offered_images(const ServeOptions& options);

std::string places_of_images(const ServeOptions& options);  // for messages

// Serves until the end. `settings`: from complete(), after which `options` may be changed. Returns the exit
// status; the reason of a failure has been written. Throws for settings that do not fit together.
int run_server(ServeOptions& options, const std::vector<Setting>& settings);

}  // namespace racebeam

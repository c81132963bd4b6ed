// The format of a machine's frames.
#pragma once

#include "environment/environment.hpp"
#include "recording/media.hpp"

namespace racebeam {

Footage footage_of(const Environment& machine);

}  // namespace racebeam

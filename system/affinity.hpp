// The processors that the calling thread may run on. Threads that it starts inherit them.
#pragma once

#include <vector>

namespace racebeam {

// The numbers of these processors, in ascending order; empty if the system does not say.
std::vector<unsigned> allowed_processors();

}  // namespace racebeam

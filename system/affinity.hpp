// The processors that threads may run on. Threads that a thread starts inherit its processors.
#pragma once

#include <thread>
#include <vector>

namespace racebeam {

// The numbers of those of the calling thread, in ascending order; empty if the system does not report them.
std::vector<unsigned> allowed_processors();

// The thread runs on this processor only from now on. Throws InvalidInput if the system refuses that.
void bind_to(std::jthread& thread, unsigned processor);

}  // namespace racebeam

// The processors that threads may run on. Threads that a thread starts inherit its processors.
#pragma once

#include <thread>
#include <vector>

namespace racebeam {

// The numbers of the calling thread's processors, in ascending order; empty if the system does not report
// them.
std::vector<unsigned> allowed_processors();

// From now on, the thread runs only on this processor. Throws InvalidInput if the system refuses that.
void bind_to(std::jthread& thread, unsigned processor);

}  // namespace racebeam

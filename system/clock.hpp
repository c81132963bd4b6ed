// Clocks of the system, in nanoseconds from an arbitrary origin.
#pragma once

#include <cstdint>

namespace racebeam {

std::int64_t wall_time();                  // never set back
std::int64_t processor_time();             // processor time that the calling thread has used
std::int64_t processor_time_of_process();  // processor time that all its threads have used

}  // namespace racebeam

// The processor time of this process. Measurements use it because other processes do not change it much.
#pragma once

#include "system/clock.hpp"

namespace racebeam {

inline double cpu_seconds() { return static_cast<double>(processor_time_of_process()) * 1e-9; }

}  // namespace racebeam

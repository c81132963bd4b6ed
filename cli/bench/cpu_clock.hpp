// The processor time of this process. Measurements use it because other processes do not change it much.
#pragma once

#include <time.h>

namespace racebeam {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

}  // namespace racebeam

#include "system/clock.hpp"

#include <time.h>

namespace racebeam {

// CLOCK_MONOTONIC_RAW counts nanoseconds, while CLOCK_MONOTONIC counts only microseconds.
std::int64_t wall_time() { return static_cast<std::int64_t>(::clock_gettime_nsec_np(CLOCK_MONOTONIC_RAW)); }
std::int64_t processor_time() {
  return static_cast<std::int64_t>(::clock_gettime_nsec_np(CLOCK_THREAD_CPUTIME_ID));
}
std::int64_t processor_time_of_process() {
  return static_cast<std::int64_t>(::clock_gettime_nsec_np(CLOCK_PROCESS_CPUTIME_ID));
}

}  // namespace racebeam

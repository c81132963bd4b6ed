#include "system/clock.hpp"

#include <time.h>

namespace racebeam {
namespace {

std::int64_t nanoseconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t wall_time() { return nanoseconds(CLOCK_MONOTONIC); }
std::int64_t processor_time_of_process() { return nanoseconds(CLOCK_PROCESS_CPUTIME_ID); }
std::int64_t processor_time() { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace racebeam

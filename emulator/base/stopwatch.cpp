#include "emulator/base/stopwatch.hpp"

#include <time.h>

namespace racebeam {
namespace {

template <clockid_t kClock>
std::int64_t nanoseconds() {
  timespec now{};
  clock_gettime(kClock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

constexpr Clocks kHostClocks{nanoseconds<CLOCK_MONOTONIC>, nanoseconds<CLOCK_THREAD_CPUTIME_ID>};

}  // namespace

const Clocks& host_clocks() { return kHostClocks; }

}  // namespace racebeam

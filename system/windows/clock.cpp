#include "system/clock.hpp"

#include <windows.h>

#include <chrono>

namespace racebeam {
namespace {

std::int64_t count(const FILETIME& time) {
  return static_cast<std::int64_t>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime);
}

}  // namespace

std::int64_t wall_time() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The unit is 100 ns, but the system counts in ticks of some 15 ms.
std::int64_t processor_time() {
  FILETIME began, ended, kernel{}, user{};
  GetThreadTimes(GetCurrentThread(), &began, &ended, &kernel, &user);
  return 100 * (count(kernel) + count(user));
}

std::int64_t processor_time_of_process() {
  FILETIME began, ended, kernel{}, user{};
  GetProcessTimes(GetCurrentProcess(), &began, &ended, &kernel, &user);
  return 100 * (count(kernel) + count(user));
}

}  // namespace racebeam

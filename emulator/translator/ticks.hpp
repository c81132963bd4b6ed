// The processor's time stamp counter.
#pragma once

#include <x86intrin.h>

#include <cstdint>

namespace racebeam::translator {

// Some two to four ticks a nanosecond. A read of the system's clock would take as long as a short frame.
inline std::int64_t ticks() { return static_cast<std::int64_t>(__rdtsc()); }

}  // namespace racebeam::translator

// The time that a piece of work takes. Policies that choose the faster of two methods compare such times.
#pragma once

#include <algorithm>
#include <cstdint>

namespace racebeam {

// Clocks of the host, in nanoseconds from an arbitrary origin. Tests have their own clocks.
struct Clocks {
  std::int64_t (*wall)();       // takes some nanoseconds to read
  std::int64_t (*processor)();  // what the calling thread has used; a system call
};

const Clocks& host_clocks();

// Whether no policy may measure, so that a run does the same work each time: everything is translated, and
// frames that are not observed are followed. The environment variable RACEBEAM_POLICY sets this: `fixed`, or
// `measured`, as without it. Throws InvalidInput for another value.
bool policies_are_fixed();

// Measures processor time, since a thread that waits for a busy processor waits longer than many frames take.
// Begin and end on one thread.
class Stopwatch {
 public:
  explicit Stopwatch(const Clocks& clocks = host_clocks())
      : clocks_(clocks), wall_(clocks.wall()), processor_(clocks.processor()) {}

  // Where the system counts processor time in ticks of milliseconds, this is wall time.
  std::int64_t elapsed() const {
    const std::int64_t processor = clocks_.processor() - processor_, wall = clocks_.wall() - wall_;
    return processor > 0 ? std::min(processor, wall) : wall;
  }

 private:
  const Clocks& clocks_;
  const std::int64_t wall_, processor_;
};

}  // namespace racebeam

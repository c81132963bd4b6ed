// What paces a machine: it is told of every frame that runs, so that long work can be cut into slices.
#pragma once

#include <cstdint>

namespace racebeam {

class Pace {
 public:
  virtual ~Pace() = default;

  // Called after each frame, those of powering on and of resets included, but not for a frame that is run
  // again because its pixels are asked for. May suspend the caller for a while. May throw to give the work
  // up; the machine is then between two frames.
  virtual void frame() = 0;

  virtual std::int64_t frames() const = 0;  // that ran so far
};

}  // namespace racebeam

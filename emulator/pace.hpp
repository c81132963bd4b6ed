// Paces a machine: it is notified of every frame that runs, so that long work can be divided into slices.
#pragma once

#include <cstdint>

namespace racebeam {

class Pace {
 public:
  virtual ~Pace() = default;

  // Called after each frame, including those of power-on and resets, but not for a frame that is run again
  // because its pixels are read. May suspend the caller for a while. May throw to abandon the work; the
  // machine is then between two frames.
  virtual void frame() = 0;

  virtual std::int64_t frames() const = 0;  // that ran so far
};

}  // namespace racebeam

// Back-off after steps that were too long for translated code, and were interpreted again.
#pragma once

#include <algorithm>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

// After such a step, the next ones are interpreted at once: one, then three, up to kLongestBackoff. The count
// halves after kCalmSteps steps that translated code completed, so that a game that thinks for some frames is
// translated again soon.
class StepBackoff {
 public:
  bool skips_step() { return left_ > 0 && left_-- > 0; }

  // whole: translated code completed the step.
  void record(bool whole) {
    if (whole) {
      if (++calm_ % tuning::kCalmSteps == 0) length_ /= 2;
      return;
    }
    calm_ = 0;
    left_ = length_ = std::min(2 * length_ + 1, tuning::kLongestBackoff);
  }

 private:
  int length_ = 0, left_ = 0, calm_ = 0;  // steps
};

}  // namespace racebeam

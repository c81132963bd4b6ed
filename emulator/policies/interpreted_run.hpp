// How many instructions the interpreter runs before the next search for translated code.
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

// The count doubles each time that no profitable code is found, because a search costs as much as
// interpreting a few instructions.
class InterpretedRun {
 public:
  // minimum: of the instructions that cannot be translated, whatever the count.
  std::int32_t next(std::int32_t minimum) {
    const std::int32_t length = std::max(length_, minimum);
    length_ = std::min(2 * length_, tuning::kLongestRun);
    return length;
  }
  void reset() { length_ = 1; }

 private:
  std::int32_t length_ = 1;
};

}  // namespace racebeam

// A step as the TIA saw it: its state before, and the writes. Pixels and collisions follow only from these,
// so that they can be made later, without CPU, RIOT, cartridge and sound.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/state/state.hpp"

namespace racebeam {

struct RecordedStep {
  TiaState start;          // the frame has begun already
  std::int32_t lines = 0;  // FrameState::lines before the step
  std::int32_t base = 0;   // the cycle that the writes' cycles count from
  std::int32_t last_access = 0;
  bool closed = false;                // the last access closed the frame
  std::vector<std::uint32_t> writes;  // TiaWrite::packed()
};

}  // namespace racebeam

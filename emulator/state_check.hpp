// Checks a state from an untrusted source. A state that passes may be meaningless to the game, but runs
// within bounds.
#pragma once

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/beam.hpp"

namespace racebeam {

// Throws InvalidInput, with the field, its value and what is accepted. `video` and `slot` are those of the
// console that will be restored.
void check_state(const State& state, const Video& video, const CartridgeSlot& slot);

}  // namespace racebeam

// Is this a state that a machine can be in? Asked of states that come from elsewhere: what passes may play
// nonsense, but runs within bounds, like any other.
#pragma once

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/beam.hpp"

namespace racebeam {

// Throws InvalidInput, with a sentence that names the field, its value and what is accepted. `video`
// and `slot` are those of the console that is to go on with `state`.
void check_state(const State& state, const Video& video, const Slot& slot);

}  // namespace racebeam

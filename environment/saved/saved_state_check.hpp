// Is this a state that an environment can be in? Asked of states that come as bytes: a checksum says that
// nobody altered them by accident, not that the sender meant well.
#pragma once

#include "emulator/base/mersenne_twister.hpp"
#include "environment/saved_state.hpp"

namespace racebeam {

// Throws InvalidInput, naming what is wrong, for values of `play` that acts and resets of `game`
// could not have left. Settings are not looked at: a state may be restored under others.
void check_play(const EpisodeState& play, const Game& game);

// The same for a rule's variables and for the sound channels. Any value of a variable is possible.
void check_tally(const Tally& tally, const Game& game);
void check_sound(const Sound& sound);

// The generator's words, and the position in them that follows.
void check_generator(std::span<const std::uint32_t, MersenneTwister::state_size> words, std::uint32_t position);

}  // namespace racebeam

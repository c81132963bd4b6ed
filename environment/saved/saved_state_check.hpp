// Checks a state from an untrusted source. A checksum only shows that the state was not altered by accident.
#pragma once

#include "emulator/base/mersenne_twister.hpp"
#include "environment/saved_state.hpp"

namespace racebeam {

// Throws InvalidInput, with what is wrong, for values of `play` that acts and resets of `game` cannot
// produce. Settings are not checked: a state may be restored under others.
void check_play(const EpisodeState& play, const Game& game);

// Checks a rule's variables and the sound channels. Any value of a variable is possible.
void check_rule_state(const RuleState& state, const Game& game);
void check_sound(const Sound& sound);

// Checks the generator's words, and the position in them.
void check_generator(std::span<const std::uint32_t, MersenneTwister::kWords> words, std::uint32_t position);

}  // namespace racebeam

// Whether two machines will behave the same from now on: Environment::state_hash() and same_state().
#pragma once

#include <cstdint>
#include <span>

#include "emulator/state/state.hpp"
#include "environment/episode_state.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

// The parts of a state that count. Only some members of `play` do.
struct StateParts {
  const State& machine;
  const EpisodeState& play;
  const RuleState& rule;
  std::span<const std::uint8_t> cartridge_ram;
};

std::uint64_t state_hash(const StateParts& parts);
bool same_state(const StateParts& a, const StateParts& b);

}  // namespace racebeam

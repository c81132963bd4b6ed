// Begins an episode as the line protocol's `load` does.
#pragma once

#include <cstdint>

#include "environment/environment.hpp"
#include "environment/input/noops.hpp"
#include "environment/input/play_noops.hpp"
#include "environment/settings/play_settings.hpp"

namespace racebeam {

// Powers the machine on anew. Throws InvalidInput for a mode or a difficulty that the game lacks.
inline void begin_episode(Environment& machine, const PlaySettings& play, std::uint32_t seed) {
  machine.reload(seed);
  if (play.mode) machine.set_mode(*play.mode);
  if (play.difficulty) machine.set_difficulty(*play.difficulty);
  if (play.mode || play.difficulty || play.noop_max > 0) machine.reset_game();
  play_noops(machine, Noops(seed, play.noop_max).draw());
}

}  // namespace racebeam

// Frames of NOOP at the start of an episode.
#pragma once

#include "environment/environment.hpp"

namespace racebeam {

// A game that ends within these frames is reset.
inline void play_noops(Environment& machine, int frames) {
  for (; frames > 0; --frames) {
    machine.act_for(1, 0);
    if (machine.game_over()) machine.reset_game();
  }
}

}  // namespace racebeam

// The built-in game as the tests of the library play it.
#pragma once

#include "racebeam/racebeam.hpp"

namespace beamfall {

inline racebeam::Image image() { return racebeam::Image::load("builtin:beamfall"); }

// Four frames a step, without sticky actions: protocol/PROTOCOL.md, "States", plays the same.
inline racebeam::Settings settings() {
  racebeam::Settings settings;
  settings.seed = 7;
  settings.frame_skip = 4;
  settings.sticky = 0;
  return settings;
}

inline racebeam::Environment environment() { return racebeam::Environment(image(), settings()); }

inline int score_of(racebeam::Environment& environment, int steps) {
  int score = 0;
  for (int step = 0; step < steps; ++step) score += environment.step(racebeam::Action::kFire);
  return score;
}

}  // namespace beamfall

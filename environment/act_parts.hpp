// The common parts of an act of the environment and a step of a slot.
#pragma once

#include <algorithm>
#include <cstdint>

#include "environment/environment.hpp"

namespace racebeam {

// A reward within the limits of the settings, which are those of an int.
inline std::int32_t clamped(std::int64_t reward, const Settings& settings) {
  return static_cast<std::int32_t>(
      std::clamp<std::int64_t>(reward, settings.reward_min, settings.reward_max));
}

// How many of these frames are drawn: the last ones.
constexpr int frames_drawn(Drawing drawing, int frames) {
  switch (drawing) {
    case Drawing::kNone: return 0;
    case Drawing::kLast: return 1;
    case Drawing::kLastTwo: return 2;
    default: return frames;
  }
}

}  // namespace racebeam

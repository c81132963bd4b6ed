// Functions that an act of the environment and a step of a slot share.
#pragma once

#include <algorithm>
#include <cstdint>

#include "environment/environment.hpp"

namespace racebeam {

// Returns the reward, clamped to reward_min and reward_max.
inline std::int32_t clamped(std::int64_t reward, const Settings& settings) {
  return static_cast<std::int32_t>(
      std::clamp<std::int64_t>(reward, settings.reward_min, settings.reward_max));
}

// Returns how many of `frames` frames are drawn. They are the last ones.
constexpr int frames_drawn(Drawing drawing, int frames) {
  switch (drawing) {
    case Drawing::kNone: return 0;
    case Drawing::kLast: return 1;
    case Drawing::kLastTwo: return 2;
    default: return frames;
  }
}

}  // namespace racebeam

// Whether a game is played with paddles in either port.
#pragma once

#include "environment/environment.hpp"

namespace racebeam {

inline bool has_paddles(const Environment& environment) {
  const Properties properties = environment.game().properties_for(environment.image().md5);
  return properties.left == Controller::kPaddles || properties.right == Controller::kPaddles;
}

}  // namespace racebeam

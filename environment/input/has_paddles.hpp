// The properties of the console that a game is played on, and whether it has paddles in either port.
#pragma once

#include "environment/environment.hpp"

namespace racebeam {

inline Properties properties_of(const Environment& environment) {
  return environment.game().properties_for(environment.image().md5);
}

inline bool has_paddles(const Environment& environment) {
  const Properties properties = properties_of(environment);
  return properties.left == Controller::kPaddles || properties.right == Controller::kPaddles;
}

}  // namespace racebeam

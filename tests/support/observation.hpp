// All outputs of an environment, in one value that can be compared.
#pragma once

#include <cstdint>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam::test {

struct Observation {
  std::vector<std::uint8_t> screen, ram, audio;
  std::vector<int> numbers;
  bool operator==(const Observation&) const = default;
};

inline Observation observe(const Environment& environment, int reward = 0) {
  const auto copy = [](auto bytes) { return std::vector<std::uint8_t>(bytes.begin(), bytes.end()); };
  return {copy(environment.screen()),
          copy(environment.ram()),
          copy(environment.audio()),
          {reward, environment.terminal(), environment.truncated(), environment.lives(),
           environment.frame_number(), environment.episode_frame_number(), environment.mode(),
           environment.difficulty()}};
}

inline Observation act(Environment& environment, int action, int b = 18) {
  const int reward = environment.act(action, b);
  Observation observation = observe(environment, reward);
  if (environment.game_over()) environment.reset_game();
  return observation;
}

}  // namespace racebeam::test

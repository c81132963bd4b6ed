// Converts actions from Python to those of a Batch.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "environment/input/action_set.hpp"
#include "environment/vector/batch.hpp"

namespace racebeam::python {

// All machines have as many actions as the first. Throws std::out_of_range for another index.
template <class Index>
std::vector<int> indices_of(const Batch& batch, std::span<const Index> actions) {
  const auto end = static_cast<Index>(batch.actions(0).size());
  std::vector<int> indices;
  indices.reserve(actions.size());
  for (const Index action : actions) {
    if (action < 0 || action >= end)
      throw std::out_of_range("action " + std::to_string(action) + " is out of range; accepted: 0 to " +
                              std::to_string(end - 1));
    indices.push_back(static_cast<int>(action));
  }
  return indices;
}

// joysticks: radius, angle and fire of each machine. Throws InvalidInput.
inline std::vector<Act> acts_of(std::span<const float> joysticks, float threshold) {
  std::vector<Act> acts;
  acts.reserve(joysticks.size() / 3);
  for (std::size_t at = 0; at + 2 < joysticks.size(); at += 3)
    acts.push_back(act_of(joysticks[at], joysticks[at + 1], joysticks[at + 2], threshold));
  return acts;
}

}  // namespace racebeam::python

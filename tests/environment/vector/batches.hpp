// Batches of our own image, whose episodes are short, and parts of their results.
#pragma once

#include <cstddef>
#include <vector>

#include "environment/vector/batch.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam::test {

inline std::vector<Cartridge> copies(std::size_t count) { return {count, {counter_image(), game()}}; }

inline BatchSettings short_episodes() {
  BatchSettings settings;
  settings.slot.machine.random_seed = 5;
  settings.slot.machine.sticky = 0.25F;
  settings.slot.machine.max_episode_frames = 30;
  settings.slot.noop_max = 7;
  return settings;
}

// The machine's part of an array.
template <typename T>
std::vector<T> part(const std::vector<T>& array, std::size_t machine, std::size_t machines) {
  const std::size_t size = array.size() / machines;
  return {array.begin() + std::ptrdiff_t(machine * size),
          array.begin() + std::ptrdiff_t((machine + 1) * size)};
}

}  // namespace racebeam::test

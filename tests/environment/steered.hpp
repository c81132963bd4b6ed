// An environment with the counting cartridge, and accessors of its RAM.
#pragma once

#include <random>
#include <stdexcept>

#include "environment/environment.hpp"
#include "environment/saved_state.hpp"
#include "tests/support/counter_image.hpp"

namespace racebeam::test {

constexpr int kScore = 0x10, kOver = 0x11, kLives = 0x12;  // indices of the steered game's RAM

inline Settings plain() {
  Settings settings;
  settings.random_seed = 123;
  settings.sticky = 0;
  return settings;
}

inline Environment steered(const Settings& settings = plain()) { return {counter_image(), game(), settings}; }

// A byte of RAM by its address.
inline int at(const Environment& environment, int address) {
  return environment.ram()[static_cast<std::size_t>(address - 0x80)];
}

// Draws that were taken from the environment's generator so far.
inline std::uint64_t draws(const Environment& environment) {
  const auto random = environment.save(true)->random;
  MersenneTwister counter(environment.settings().random_seed);
  for (std::uint64_t count = 0; count < 10000; ++count, counter()) {
    if (counter == *random) return count;
  }
  throw std::runtime_error("the generator is not where it should be");
}

}  // namespace racebeam::test

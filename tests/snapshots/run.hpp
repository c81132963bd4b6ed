// A random run of a game, reproducible from any of its acts on: what is done at act n depends on n alone.
#pragma once

#include <cstdint>
#include <memory>

#include "environment/environment.hpp"

namespace racebeam::test {

// How a run is played, and what its states hold.
struct Manner {
  const char* name;
  Settings settings;
  bool with_random;  // the sticky-action generator is saved
};

constexpr int kManners = 2;
Manner manner(int number);

// All that can be seen: screen, RAM, sound, reward, lives, both ends, both frame numbers, mode and
// difficulty.
std::uint64_t digest(const Environment& environment, int reward);

// Act number `n` of the run with this seed, and a new game if the last one is over. The digest of what it led
// to.
std::uint64_t act(Environment& environment, std::uint64_t seed, int n);

}  // namespace racebeam::test

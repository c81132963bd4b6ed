// A random run of a game that can be repeated from any act: act n depends only on n.
#pragma once

#include <cstdint>
#include <memory>

#include "environment/environment.hpp"

namespace racebeam::test {

// How a run is played, and what its states contain.
struct Manner {
  const char* name;
  Settings settings;
  bool with_random;  // the sticky-action generator is saved
};

constexpr int kManners = 2;
Manner manner(int number);

// A digest of all that can be observed: screen, RAM, sound, reward, lives, both ends, both frame numbers,
// mode and difficulty.
std::uint64_t digest(const Environment& environment, int reward);

// Plays act number `n` of the run with this seed, and begins a new game if the last one is over. Returns the
// digest of the result.
std::uint64_t act(Environment& environment, std::uint64_t seed, int n);

}  // namespace racebeam::test

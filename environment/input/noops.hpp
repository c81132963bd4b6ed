// How many frames of NOOP precede an agent's first action. The number is drawn as in the reference's vector
// environment (docs/spec/environment.md, 15), so that the same seed gives the same episodes.
#pragma once

#include <algorithm>
#include <cstdint>

#include "emulator/base/mersenne_twister.hpp"

namespace racebeam {

class Noops {
 public:
  Noops(std::uint32_t seed, int max)
      : random_(seed), choices_(static_cast<std::uint32_t>(std::max(max, 1))) {}

  // Draws from 0 to max - 1, without bias, by rejection. Returns 0 if max is not positive.
  int draw() {
    const std::uint32_t uneven = -choices_ % choices_;  // 2^32 mod choices
    std::uint64_t product;
    do {
      product = std::uint64_t{random_()} * choices_;
    } while (static_cast<std::uint32_t>(product) < uneven);
    return static_cast<int>(product >> 32);
  }

  const MersenneTwister& generator() const { return random_; }
  void set_generator(const MersenneTwister& generator) { random_ = generator; }

 private:
  MersenneTwister random_;
  std::uint32_t choices_;
};

}  // namespace racebeam

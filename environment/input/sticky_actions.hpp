// Sticky actions: which of the two players' actions take effect (docs/spec/environment.md, 3 and 4).
#pragma once

#include <cstdint>

#include "emulator/base/mersenne_twister.hpp"

namespace racebeam {

struct Press {
  std::int32_t action;
  float strength;  // how far a paddle turns
};

struct Presses {
  Press a{0, 1.0F};
  Press b{18, 0.0F};
};

// The reference compares a draw u / 2^32 with the probability p, in double precision. Returns the smallest u
// that lets a new action through. p is a float that has been through a decimal text of six significant
// digits.
std::uint64_t sticky_threshold(float p);

class Sticky {
 public:
  explicit Sticky(float p) : threshold_(sticky_threshold(p)) {}

  // Makes two draws, A's first, whatever p is.
  void draw(MersenneTwister& random, const Presses& asked, Presses& held) const {
    if (random() >= threshold_) held.a = asked.a;
    if (random() >= threshold_) held.b = asked.b;
  }

 private:
  std::uint64_t threshold_;
};

}  // namespace racebeam

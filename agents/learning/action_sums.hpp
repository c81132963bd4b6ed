// Sums of the weights of 18 actions, two at a time: they stay in registers, as a loop over actions would not
// keep them.
#pragma once

#include <array>
#include <cstring>

#include "agents/learning/sarsa_control.hpp"

namespace racebeam {

class ActionSums {
 public:
  void add(const float* weights) {
    for (std::size_t pair = 0; pair < sums_.size(); ++pair) sums_[pair] += two(weights, pair);
  }
  void add(const float* weights, double count) {
    for (std::size_t pair = 0; pair < sums_.size(); ++pair) sums_[pair] += two(weights, pair) * count;
  }

  ActionValues values() const {
    ActionValues values;
    std::memcpy(values.data(), sums_.data(), sizeof values);
    return values;
  }

 private:
  using Doubles [[gnu::vector_size(16)]] = double;
  using Floats [[gnu::vector_size(8)]] = float;

  static Doubles two(const float* weights, std::size_t pair) {
    Floats floats;
    std::memcpy(&floats, weights + 2 * pair, sizeof floats);
    return __builtin_convertvector(floats, Doubles);
  }

  std::array<Doubles, kActions / 2> sums_{};
};

}  // namespace racebeam

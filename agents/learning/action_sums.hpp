// Sums of the weights of 18 actions, two actions in a vector. The sums stay in registers, unlike those of a
// loop over actions.
#pragma once

#include <array>
#include <cstring>

#include "agents/learning/sarsa_control.hpp"

namespace racebeam {

class ActionSums {
 public:
  void add(const float* weights) {
    for (std::size_t four = 0; four < kFours; ++four) {
      const auto [low, high] = doubles_of_four(weights + 4 * four);
      sums_[2 * four] += low;
      sums_[2 * four + 1] += high;
    }
    sums_.back() += last_two(weights);
  }
  void add(const float* weights, double count) {
    for (std::size_t four = 0; four < kFours; ++four) {
      const auto [low, high] = doubles_of_four(weights + 4 * four);
      sums_[2 * four] += low * count;
      sums_[2 * four + 1] += high * count;
    }
    sums_.back() += last_two(weights) * count;
  }

  ActionValues values() const {
    ActionValues values;
    std::memcpy(values.data(), sums_.data(), sizeof values);
    return values;
  }

 private:
  using Doubles [[gnu::vector_size(16)]] = double;
  using FourDoubles [[gnu::vector_size(32)]] = double;
  using FourFloats [[gnu::vector_size(16)]] = float;
  struct Four {
    Doubles low, high;
  };

  static constexpr std::size_t kFours = kActions / 4;

  // GCC 12 converts two floats of four at once, but each of two on its own.
  static Four doubles_of_four(const float* weights) {
    FourFloats floats;
    std::memcpy(&floats, weights, sizeof floats);
    const FourDoubles doubles = __builtin_convertvector(floats, FourDoubles);
    return {__builtin_shufflevector(doubles, doubles, 0, 1), __builtin_shufflevector(doubles, doubles, 2, 3)};
  }
  static Doubles last_two(const float* weights) {
    return Doubles{double{weights[kActions - 2]}, double{weights[kActions - 1]}};
  }

  std::array<Doubles, kActions / 2> sums_{};
};

}  // namespace racebeam

// Scales rewards for learning and for search (docs/paper-notes.md, "Learning").
#pragma once

#include <cmath>

namespace racebeam {

enum class RewardScale {
  kFirst,  // divided by the size of the first reward that is not 0
  kNone,
  kSign  // -1, 0 or 1
};

class RewardScaler {
 public:
  explicit RewardScaler(RewardScale scale) : scale_(scale) {}

  double operator()(double reward) {
    if (scale_ == RewardScale::kNone || reward == 0) return reward;
    if (scale_ == RewardScale::kSign) return reward > 0 ? 1 : -1;
    if (first_ == 0) first_ = std::abs(reward);
    return reward / first_;
  }

 private:
  RewardScale scale_;
  double first_ = 0;  // the size of the first reward; 0: none so far
};

}  // namespace racebeam

// Whether the steps of a machine are faster translated than interpreted. That is measured, since no rule
// predicts all programs: translated code can be left too often, or be too long for the processor's caches.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "emulator/policies/tuning.hpp"

namespace racebeam {

// Steps run in one way, translated or interpreted. A trial has three steps: the usual way, the other way, and
// the usual way. Four trials make a round. The usual way changes when the other has won three rounds in turn.
// Rounds repeat a step in turn, and its least cost counts: other programs lengthen some steps.
class StepTrial {
 public:
  // Called before each step. Returns whether the interpreter should run it.
  bool begin_step() {
    --left_;
    return interprets_ != (left_ == kOther);
  }

  // Whether the step that has begun is one of a trial. Its cost must then be given to end_step().
  bool measures() const { return left_ < kSteps; }

  // cost: of the step, in any unit. Time spent on translation does not belong to it.
  void end_step(std::int64_t cost) {
    std::int64_t& least = least_[static_cast<std::size_t>(trials_ - 1)][static_cast<std::size_t>(left_)];
    least = std::min(least, cost);
    if (left_ > 0) return;
    if (--trials_ == 0) end_round();
    left_ = pause_ + kSteps;
  }

 private:
  void end_round() {
    std::int64_t present = 0, other = 0;
    for (const Trial& trial : least_) {
      present += trial[0] + trial[2];
      other += 2 * trial[kOther];
    }
    const bool other_wins = other + other / tuning::kTrialMargin < present;
    lost_ = other_wins ? lost_ + 1 : 0;
    const int longest = interprets_ ? tuning::kLongestTried : tuning::kLongestPause;
    const int growth = other > 2 * present ? tuning::kFastGrowth : 2;
    pause_ = other_wins ? tuning::kShortestPause : std::min(growth * pause_, longest);
    if (lost_ == tuning::kRoundsToLose) interprets_ = !interprets_, lost_ = 0;
    trials_ = kTrialsOfRound;
    if (lost_ == 0) least_ = kUnknown;
  }

  // What a trial and a round are; not numbers to tune. With other ones, costs would be compared of steps that
  // do different work.
  static constexpr int kSteps = 3, kOther = 1;  // the usual way, the other, the usual
  static constexpr int kTrialsOfRound = 4;      // one of each of four successive steps

  using Trial = std::array<std::int64_t, kSteps>;  // by the steps that are left after it
  using Round = std::array<Trial, kTrialsOfRound>;
  static constexpr Round kUnknown = [] {
    Round round{};
    for (Trial& trial : round) trial.fill(std::numeric_limits<std::int64_t>::max());
    return round;
  }();

  bool interprets_ = false;
  int left_ = tuning::kFirstPause + kSteps;  // steps until this trial has ended
  int pause_ = tuning::kShortestPause;       // steps between trials
  int trials_ = kTrialsOfRound;              // of this round, not ended
  int lost_ = 0;                             // rounds in turn
  Round least_ = kUnknown;                   // costs in the rounds in turn
};

}  // namespace racebeam

// Branches: several sequences of actions from one state, as a planner tries them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

// The result of one sequence, which is played to its end or to the end of the episode.
struct BranchEnd {
  std::int64_t reward = 0, reward_b = 0;  // sums over the acts
  int acts = 0, frames = 0;               // how many were played
  bool terminated = false, truncated = false;
  int lives = 0;
};

// Plays branches on an environment, act by act. The caller must not use the environment meanwhile.
class Branching {
 public:
  // Saves the state of `environment`, including its generator. life_loss: the effect of a lost life on a
  // branch.
  explicit Branching(Environment& environment, LifeLoss life_loss = LifeLoss::kIgnored);
  ~Branching();  // restores it
  Branching(const Branching&) = delete;
  Branching& operator=(const Branching&) = delete;

  // Begins a branch at `root`. If `root` has no generator, every branch begins with the generator that the
  // environment had. Throws InvalidInput for a state of another image or game.
  void enter(const Environment::Saved& root);

  bool over() const { return environment_.game_over() || life_ended_; }
  bool life_ended() const { return life_ended_; }  // by LifeLoss::kEnd: the game continues

  // Plays one act and returns player A's reward. Throws what Environment::act() throws.
  int act(const Act& act);

  // The result of the branch so far.
  const BranchEnd& end() const { return end_; }

 private:
  void check_ends();

  Environment& environment_;
  const LifeLoss life_loss_;
  bool life_ended_ = false;  // and the episode with it, but not the game
  std::shared_ptr<const Environment::Saved> undisturbed_;
  Drawing drawing_;  // to be restored: the screens of a branch are not drawn
  BranchEnd end_;
};

// Plays all sequences from `root`: ends[i] becomes the result of sequences[i]. Throws std::invalid_argument
// if the spans differ in length. The environment is unchanged afterwards, also after an exception.
void branch(Environment& environment, const Environment::Saved& root,
            std::span<const std::vector<Act>> sequences, std::span<BranchEnd> ends);

}  // namespace racebeam

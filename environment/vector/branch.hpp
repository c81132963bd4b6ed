// From one state, several lists of actions: what planners do all day.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

// What a list of actions led to. It is played until its end, or the episode's.
struct BranchEnd {
  std::int64_t reward = 0, reward_b = 0;  // sums over the acts
  int acts = 0, frames = 0;               // that were played
  bool terminated = false, truncated = false;
  int lives = 0;
};

// An environment that is lent to branches, act by act. It must not be used otherwise meanwhile.
class Branching {
 public:
  // Remembers where `environment` is, its generator included.
  explicit Branching(Environment& environment);
  ~Branching();  // puts it back there
  Branching(const Branching&) = delete;
  Branching& operator=(const Branching&) = delete;

  // Begins a branch at `root`. A state without a generator goes on with the environment's, for every branch
  // from the same place in it. Throws std::invalid_argument for a state of another image or game.
  void enter(const Environment::Saved& root);

  bool over() const { return environment_.game_over(); }

  // One act; its reward to player A. Throws as Environment::act().
  int act(const Act& act);

  // Of the branch so far.
  const BranchEnd& end() const { return end_; }

 private:
  Environment& environment_;
  std::shared_ptr<const Environment::Saved> undisturbed_;
  Drawing drawing_;  // before; the screens of a branch are not read
  BranchEnd end_;
};

// All at once: ends[i] is what sequences[i] led to; there are as many of both. Afterwards, and after a throw,
// the environment is as it was.
void branch(Environment& environment, const Environment::Saved& root,
            std::span<const std::vector<Act>> sequences, std::span<BranchEnd> ends);

}  // namespace racebeam

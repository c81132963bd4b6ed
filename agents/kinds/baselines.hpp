// The agents that do not learn, with which others are compared: Random, Const and Perturb
// (docs/paper-notes.md, "Baselines").
#pragma once

#include "agents/base/agent.hpp"
#include "agents/base/random.hpp"

namespace racebeam {

// Chooses `action` with this probability, otherwise one of `actions` at random. Random has probability 0,
// Const 1.
class FixedPolicy final : public Agent {
 public:
  FixedPolicy(int action, double probability, std::uint64_t seed,
              const std::vector<int>& actions = all_actions())
      : action_(action), probability_(probability), actions_(actions), random_(seed) {}

  int begin(const Environment&) override { return choose(); }
  int next(double, const Environment&) override { return choose(); }
  void end(double) override {}
  void write(StateWriter& out) const override { out.put(random_); }
  void read(StateReader& in) override { in.get(random_); }

 private:
  int choose() {
    if (random_.uniform() < probability_) return action_;
    return actions_[random_.below(actions_.size())];
  }

  const int action_;
  const double probability_;
  const std::vector<int> actions_;
  Random random_;
};

}  // namespace racebeam

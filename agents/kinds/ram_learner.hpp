// An agent that learns by SARSA(lambda) on RAM, where traces are short enough for RamSarsa.
#pragma once

#include <vector>

#include "agents/base/agent.hpp"
#include "agents/learning/ram_sarsa.hpp"

namespace racebeam {

class RamLearner final : public Agent {
 public:
  // actions: those that it chooses from.
  RamLearner(const SarsaSettings& settings, std::uint64_t seed, const std::vector<int>& actions)
      : actions_(actions), sarsa_(settings, seed, static_cast<int>(actions.size())) {}

  int begin(const Environment& environment) override { return action(sarsa_.begin(environment.ram())); }
  int next(double reward, const Environment& environment) override {
    return action(sarsa_.next(reward, environment.ram()));
  }
  void end(double reward) override { sarsa_.end(reward); }

  void set_learning(bool learning) override { sarsa_.set_learning(learning); }
  bool diverged() const override { return sarsa_.diverged(); }
  void write(StateWriter& out) const override { sarsa_.write(out); }
  void read(StateReader& in) override { sarsa_.read(in); }

 private:
  int action(int number) const { return actions_[static_cast<std::size_t>(number)]; }

  const std::vector<int> actions_;
  RamSarsa sarsa_;
};

}  // namespace racebeam

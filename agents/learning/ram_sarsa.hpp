// SARSA(lambda) on the bits of RAM and all pairs of them (appendix A.5 of the paper). It learns what Sarsa
// does on the features of RamBits, but for rounding, in a fraction of the time.
#pragma once

#include <cstdint>

#include "agents/learning/pair_weights.hpp"
#include "agents/learning/sarsa_control.hpp"

namespace racebeam {

class RamSarsa {
 public:
  using Ram = PairWeights::Ram;

  // Throws std::invalid_argument where PairWeights does.
  RamSarsa(const SarsaSettings& settings, std::uint64_t seed, int actions = kActions)
      : control_(settings, static_cast<std::size_t>(actions), seed), weights_(settings) {}

  int begin(Ram ram);  // returns the first action of an episode
  // The reward of the action before, and the state that it led to. Returns the next action.
  int next(double reward, Ram ram);
  void end(double reward);  // of the last action

  void set_learning(bool learning) { control_.set_learning(learning); }
  bool diverged() const { return control_.diverged(); }
  const PairWeights& weights() const { return weights_; }

  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  void learn(double target, double value, std::size_t features);
  double value_of_action() const { return weights_.values()[static_cast<std::size_t>(action_)]; }

  SarsaControl control_;
  PairWeights weights_;
  int action_ = 0;
};

}  // namespace racebeam

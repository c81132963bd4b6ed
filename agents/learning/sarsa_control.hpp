// The part of SARSA(lambda) that does not depend on how values are represented: it scales rewards, chooses
// actions, and computes step sizes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "games/game/actions.hpp"

namespace racebeam {

// Defaults: "Experimental Parameters" of the paper, appendix C, where not said otherwise.
struct SarsaSettings {
  double step_size = 0.5;                // alpha, of Basic, BASS and LSH
  double trace_decay = 0.9;              // lambda, of Basic, BASS and DISCO
  double discount = 0.999;               // gamma, of all agents
  double exploration = 0.05;             // epsilon, of all agents
  double evaluation_exploration = 0.05;  // paper-notes: in evaluation, too
  double least_trace = 0.01;             // paper-notes: smaller traces are dropped
  bool clear_other_traces = false;       // paper-notes: of the same feature, those of the actions not taken
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
};

using ActionValues = std::array<double, kActions>;

class SarsaControl {
 public:
  SarsaControl(const SarsaSettings& settings, std::size_t actions, std::uint64_t seed)
      : settings_(settings), actions_(actions), scaled_(settings.reward_scale), random_(seed) {}

  const SarsaSettings& settings() const { return settings_; }
  std::size_t actions() const { return actions_; }

  // Explores with the probability of the settings. Chooses each of the best actions with equal probability.
  int choose(const ActionValues& values);
  double scaled(double reward) { return scaled_(reward); }
  // Returns how far a weight with a trace of 1 moves; nothing if that is not finite. error: of the value.
  // gain: how far a step of 1 moves the value of the state.
  std::optional<float> step(double error, double gain);

  void set_learning(bool learning) { learning_ = learning; }
  bool is_learning() const { return learning_; }
  bool diverged() const { return diverged_; }

  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  SarsaSettings settings_;
  std::size_t actions_;
  double largest_gain_ = 1;  // so far; a step is divided by it, so that no update overshoots its target
  RewardScaler scaled_;
  bool learning_ = true, diverged_ = false;
  Random random_;
};

}  // namespace racebeam

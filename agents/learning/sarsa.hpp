// SARSA(lambda) over linear features, with replacing traces and an epsilon-greedy policy. Bellemare et al.
// 2013, section 3.1; Sutton and Barto 1998, section 8.4. docs/paper-notes.md says what the paper leaves open.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "agents/base/huge_pages.hpp"
#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/features/feature_set.hpp"
#include "agents/learning/feature_groups.hpp"
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

class Sarsa {
 public:
  // features: the number of indices; 0: none are known yet, and refine() adds them. actions: at most 18.
  // Throws InvalidInput for more features than traces can number.
  Sarsa(const SarsaSettings& settings, std::size_t features, std::uint64_t seed, int actions = kActions);

  // The first action of an episode, in a state with these features.
  int begin(const ActiveFeatures& features);
  // The reward of the action before, and the state that it led to. Returns the next action.
  int next(double reward, const ActiveFeatures& features);
  // The reward of the last action. The value of what follows is 0.
  void end(double reward);

  // There are so many groups of features now. Each that was split off has the weights and the traces of the
  // one that it was a part of. Must precede the first use of a new group.
  void refine(std::size_t groups, std::span<const FeatureSplit> splits);

  void set_learning(bool learning) { learning_ = learning; }
  bool diverged() const { return diverged_; }

  double weight(std::size_t feature, int action) const { return weights_[place(feature, action)]; }
  double value(const ActiveFeatures& features, int action) const;
  double trace(std::size_t feature, int action) const;  // 0: none

  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  struct Trace {
    std::uint32_t place;  // of the weight
    float size;
  };
  using Values = std::array<double, kActions>;

  std::size_t place(std::size_t feature, int action) const {
    return feature * actions_ + static_cast<std::size_t>(action);
  }
  void compute_values(const ActiveFeatures& features);
  template <bool kCounted>
  void compute_all_values(const ActiveFeatures& features);
  void fetch_weights(const ActiveFeatures& features, std::size_t i) const;
  int choose();
  static double gain(const ActiveFeatures& features);
  void update(double error);
  void move_weights(float step);
  void split(const FeatureSplit& part);

  SarsaSettings settings_;
  std::size_t actions_;
  bool grows_;                 // refine() adds features
  HugeTable<float> weights_;   // of all actions of feature 0, then of feature 1, ...
  std::vector<Trace> traces_;  // by ascending place; without other traces, at most one a feature
  std::vector<Trace> merged_;  // room for the next
  Values values_{};            // of the state that was last seen
  ActiveFeatures features_;    // of the state in which action_ was taken
  int action_ = 0;
  double largest_gain_ = 1;  // so far; a step is divided by it, so that no update overshoots its target
  RewardScaler scaled_;
  bool learning_ = true, diverged_ = false;
  Random random_;
};

}  // namespace racebeam

// SARSA(lambda) over linear features, with replacing traces and an epsilon-greedy policy. Bellemare et al.
// 2013, section 3.1; Sutton and Barto 1998, section 8.4. docs/paper-notes.md says what the paper leaves open.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/base/huge_pages.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/features/feature_set.hpp"
#include "agents/learning/feature_groups.hpp"
#include "agents/learning/sarsa_control.hpp"
#include "games/game/actions.hpp"

namespace racebeam {

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

  // Adds the groups of features that were split off. groups: how many there are now. A new group gets the
  // weights and the traces of the group that it was a part of. Must precede the first use of a new group.
  void refine(std::size_t groups, std::span<const FeatureSplit> splits);

  void set_learning(bool learning) { control_.set_learning(learning); }
  bool diverged() const { return control_.diverged(); }

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

  std::size_t place(std::size_t feature, int action) const {
    return feature * actions_ + static_cast<std::size_t>(action);
  }
  void compute_values(const ActiveFeatures& features);
  template <bool kCounted>
  void compute_all_values(const ActiveFeatures& features);
  void fetch_weights(const ActiveFeatures& features, std::size_t i) const;
  static double gain(const ActiveFeatures& features);
  void update(double error);
  void move_weights(float step);
  void split(const FeatureSplit& part);

  SarsaControl control_;
  std::size_t actions_;
  bool grows_;                 // refine() adds features
  HugeTable<float> weights_;   // of all actions of feature 0, then of feature 1, ...
  std::vector<Trace> traces_;  // by ascending place; without other traces, at most one a feature
  std::vector<Trace> merged_;  // memory for the next traces_
  ActionValues values_{};      // of the state that was last seen
  ActiveFeatures features_;    // of the state in which action_ was taken
  int action_ = 0;
};

}  // namespace racebeam

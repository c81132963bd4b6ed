// An agent that learns by SARSA(lambda) on a set of features, or on groups of them that share weights.
#pragma once

#include <memory>
#include <optional>

#include "agents/base/agent.hpp"
#include "agents/features/feature_set.hpp"
#include "agents/learning/sarsa.hpp"

namespace racebeam {

class Learner final : public Agent {
 public:
  // actions: those that it chooses from.
  Learner(std::unique_ptr<FeatureSet> features, const SarsaSettings& settings, std::uint64_t seed,
          const std::vector<int>& actions = all_actions())
      : features_(std::move(features)),
        actions_(actions),
        sarsa_(settings, features_->size(), seed, static_cast<int>(actions.size())) {}
  Learner(std::unique_ptr<FeatureSet> features, FeatureGroups groups, const SarsaSettings& settings,
          std::uint64_t seed, const std::vector<int>& actions)
      : features_(std::move(features)),
        groups_(std::move(groups)),
        actions_(actions),
        sarsa_(settings, 0, seed, static_cast<int>(actions.size())) {}

  Drawing drawing() const override { return features_->reads_screen() ? Drawing::kLast : Drawing::kNone; }

  int begin(const Environment& environment) override {
    features_->begin_episode();
    look(environment);
    return action(sarsa_.begin(active_));
  }
  int next(double reward, const Environment& environment) override {
    look(environment);
    return action(sarsa_.next(reward, active_));
  }
  void end(double reward) override { sarsa_.end(reward); }

  void set_learning(bool learning) override { sarsa_.set_learning(learning); }
  bool diverged() const override { return sarsa_.diverged(); }
  void write(StateWriter& out) const override {
    sarsa_.write(out);
    if (groups_) groups_->write(out);
  }
  void read(StateReader& in) override {
    sarsa_.read(in);
    if (groups_) groups_->read(in);
  }

 private:
  int action(int number) const { return actions_[static_cast<std::size_t>(number)]; }

  void look(const Environment& environment) {
    features_->extract(environment, active_);
    if (!groups_) return;
    const std::span<const FeatureSplit> splits = groups_->replace(active_);
    sarsa_.refine(groups_->count(), splits);
  }

  const std::unique_ptr<FeatureSet> features_;
  std::optional<FeatureGroups> groups_;
  const std::vector<int> actions_;
  Sarsa sarsa_;
  ActiveFeatures active_;
};

}  // namespace racebeam

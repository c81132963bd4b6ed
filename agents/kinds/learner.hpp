// An agent that learns by SARSA(lambda) on a set of features.
#pragma once

#include <memory>

#include "agents/base/agent.hpp"
#include "agents/features/feature_set.hpp"
#include "agents/learning/sarsa.hpp"

namespace racebeam {

class Learner final : public Agent {
 public:
  Learner(std::unique_ptr<FeatureSet> features, const SarsaSettings& settings, std::uint64_t seed)
      : features_(std::move(features)), sarsa_(settings, features_->size(), seed) {}

  Drawing drawing() const override { return features_->reads_screen() ? Drawing::kLast : Drawing::kNone; }

  int begin(const Environment& environment) override {
    features_->begin_episode();
    features_->extract(environment, active_);
    return sarsa_.begin(active_);
  }
  int next(double reward, const Environment& environment) override {
    features_->extract(environment, active_);
    return sarsa_.next(reward, active_);
  }
  void end(double reward) override { sarsa_.end(reward); }

  void set_learning(bool learning) override { sarsa_.set_learning(learning); }
  bool diverged() const override { return sarsa_.diverged(); }
  void write(StateWriter& out) const override { sarsa_.write(out); }
  void read(StateReader& in) override { sarsa_.read(in); }

 private:
  const std::unique_ptr<FeatureSet> features_;
  Sarsa sarsa_;
  ActiveFeatures active_;
};

}  // namespace racebeam

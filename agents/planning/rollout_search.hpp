// Rollout-IW(1) (Bandres, Bonet and Geffner 2018): IW(1) by random ways down a tree, so that it has an answer
// at any time. docs/paper-notes.md says what they leave open.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/planning/model.hpp"

namespace racebeam {

struct RolloutSettings {
  std::int64_t frames = 150000;  // of a decision
  double discount = 0.995;
  bool reuse_tree = true;  // the next tree begins with the chosen child's, which costs nothing
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
};

class RolloutSearch {
 public:
  RolloutSearch(Model& model, const RolloutSettings& settings, std::uint64_t seed)
      : model_(model), settings_(settings), random_(seed), scaled_(settings.reward_scale) {}

  // The action with the largest discounted sum of rewards. Begins with the tree that keep() left, if there is
  // one.
  int choose(const Model::State& root);

  // After choose(): with `reuse_tree`, the subtree of `action` is the next tree, if its root has the state to
  // which the world went.
  void keep(int action, const Model::State& state);

  void forget() { root_.reset(); }

  std::size_t nodes() const;                        // of the tree
  double value(int action) const;                   // of the root's child; 0 without a child
  bool exhausted() const { return root_->solved; }  // the last search left nothing that is new
  std::int64_t frames() const { return frames_; }   // of the last search

  // What goes on from search to search, for checkpoints.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  struct Node {
    Model::State state;
    std::vector<std::uint8_t> features;
    Node* parent = nullptr;
    double reward = 0;  // on the way here
    double best = 0;    // over the children: reward + discount * best
    bool over = false;
    bool solved = false;                               // nothing below is new
    std::int64_t search = 0;                           // the last one that came here
    std::vector<std::unique_ptr<Node>> children = {};  // one for each action; null: it was not tried
  };

  std::unique_ptr<Node> make_node() const;
  void roll_out();
  Node* grow(Node& node, std::size_t action);
  std::size_t open_action(const Node& node);
  bool is_new(Node& node, int depth);
  static void solve(Node* node);
  void back_up(Node* node) const;
  double value(const Node& child) const { return child.reward + settings_.discount * child.best; }
  int best_action();

  Model& model_;
  const RolloutSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::unique_ptr<Node> root_;
  std::vector<int> depths_;  // per byte of the features and per value: the least at which it was seen
  std::int64_t search_ = 0, end_ = 0, frames_ = 0;
};

}  // namespace racebeam

// Rollout-IW(1) (Bandres, Bonet and Geffner 2018): IW(1) by random rollouts down a tree, so that it has an
// answer at any time. docs/paper-notes.md says what they leave open.
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
  std::int64_t frames = 150000;  // that a decision may take
  double discount = 0.995;
  bool reuse_tree = true;  // the next tree begins with the chosen child's, which costs nothing
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
  std::size_t most_nodes = 2'000'000;              // that a tree may have, as in TreeSettings
};

class RolloutSearch {
 public:
  RolloutSearch(Model& model, const RolloutSettings& settings, std::uint64_t seed)
      : model_(model), settings_(settings), random_(seed), scaled_(settings.reward_scale) {}

  // Searches from `root`, and returns the action with the largest discounted sum of rewards. Continues the
  // tree that keep() has left, if there is one.
  int choose(const Model::State& root);

  // Called after choose(), with the action that was taken and the state that it led to. With `reuse_tree`,
  // keeps the subtree of the action for the next choose(), if it begins with that state.
  void keep(int action, const Model::State& state);

  void forget() { root_.reset(); }

  std::size_t nodes() const;                        // of the tree
  double value(int action) const;                   // of the root's child; 0 without a child
  bool exhausted() const { return root_->solved; }  // whether the last search has found all novel states
  std::int64_t frames() const { return frames_; }   // of the last search

  // Write and read what persists between searches, for checkpoints.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  struct Node {
    Model::State state;
    std::vector<std::uint8_t> features;
    Node* parent = nullptr;
    double reward = 0;  // of the action that led here
    double best = 0;    // the largest value of a child: reward + discount * best
    bool over = false;
    bool solved = false;                               // nothing below is novel
    std::int64_t search = 0;                           // the number of the last search that came here
    std::vector<std::unique_ptr<Node>> children = {};  // one for each action; null: it was not tried
  };

  std::unique_ptr<Node> make_node() const;
  bool may_expand() const { return model_.frames() < end_ && count_ < settings_.most_nodes; }
  void roll_out();
  Node* expand(Node& node, std::size_t action);
  std::size_t open_action(const Node& node);
  bool is_novel(Node& node, int depth);
  static void solve(Node* node);
  void back_up(Node* node) const;
  double value(const Node& child) const { return child.reward + settings_.discount * child.best; }
  int best_action();

  Model& model_;
  const RolloutSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::unique_ptr<Node> root_;
  std::vector<int> depths_;  // the novelty table: per feature and value, the least depth at which it was seen
  std::int64_t search_ = 0, end_ = 0, frames_ = 0;
  std::size_t count_ = 0;  // nodes of the tree, while it is searched
};

}  // namespace racebeam

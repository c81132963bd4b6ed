// The best action by a whole tree of what may happen, breadth first: the full tree of Bellemare et al. 2013,
// section 3.2.1, and IW(1) of Lipovetzky et al. 2015, which drops places without a new byte of RAM.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/planning/model.hpp"

namespace racebeam {

// Defaults: the paper, appendix C, where not said otherwise.
struct TreeSettings {
  std::int64_t frames = 133000;  // of a decision; no node is expanded after them
  double discount = 0.999;
  bool merge_duplicates = false;  // paper-notes: of siblings in the same state one is expanded
  bool needs_novelty = false;     // IW(1)
  bool reuse_tree = false;        // paper-notes: the next tree begins with the chosen child's
  bool reward_aside = false;      // paper-notes: new nodes with a reward are opened when no others are left
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
};

class TreeSearch {
 public:
  TreeSearch(Model& model, const TreeSettings& settings, std::uint64_t seed);

  // The action with the largest discounted sum of rewards. Begins with the tree that keep() left, if there is
  // one.
  int choose(const Model::State& root);

  // After choose(): with `reuse_tree`, the subtree of `action` is the beginning of the next tree, if its
  // root has the state to which the world went.
  void keep(int action, const Model::State& state);

  void forget() { kept_ = false; }

  std::size_t nodes() const { return nodes_.size(); }  // of the tree
  double value(int action) const;                      // of the root's child; 0 without a child
  std::int64_t frames() const { return frames_; }      // of the last search

  // What goes on from search to search, for checkpoints. read() throws InvalidInput for what write() cannot
  // have written.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  using Number = std::uint32_t;
  struct Node {
    Model::State state = nullptr;  // empty: it is never expanded
    std::uint64_t hash = 0;
    Number parent = 0;
    Number first_child = 0;  // all children stand together; 0: it has not been expanded
    Number twin = 0;         // the sibling in the same state, which is expanded for both; 0: none
    int action = 0;
    std::int32_t frames = 0;  // of the action
    bool over = false;
    bool opened = false;  // it was new when it was looked at, so that it is to be expanded
    double reward = 0;
    double best = 0;  // over the children: reward + discount * best
  };

  void begin(const Model::State& root);
  Number next_open();
  void visit(Number number);
  void expand(Number parent);
  void add_child(Number parent, int action, Number first_sibling);
  Number twin_of(const Node& child, Number first_sibling) const;
  void look_again(Node& node);
  bool is_new();  // whether the model's place has a byte that was not seen in this search
  double value(const Node& child) const { return child.reward + settings_.discount * child.best; }
  void back_up();
  int best_action();
  Number child_of_root(int action) const;  // 0 if the root lacks it
  void move_root(Number to);

  Model& model_;
  const TreeSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::vector<Node> nodes_;          // a parent before its children, and these behind its siblings
  bool kept_ = false;                // they are the next tree's
  std::deque<Number> open_, aside_;  // to be visited
  std::vector<bool> seen_;           // per byte of the features and per value
  std::vector<int> order_;           // of the actions at a node; each draw begins with the one before
  std::int64_t frames_ = 0;
};

}  // namespace racebeam

// Breadth-first tree search: the full tree of Bellemare et al. 2013, section 3.2.1, and IW(1) of Lipovetzky
// et al. 2015, which prunes states without a novel byte of RAM.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/planning/model.hpp"

namespace racebeam {

// Which nodes are put aside, and opened when no others are left: none, those with a positive reward in the
// search that finds them, or all whose reward is not 0, in each search.
enum class RewardAside { kNone, kNew, kAll };

// Defaults: the paper, appendix C, where not said otherwise.
struct TreeSettings {
  std::int64_t frames = 133000;  // that a decision may take; no node is expanded after them
  double discount = 0.999;
  bool merge_duplicates = false;  // paper-notes: of siblings in the same state, one is expanded for all
  bool needs_novelty = false;     // IW(1)
  bool reuse_tree = false;        // paper-notes: the next tree begins with the chosen child's
  RewardAside reward_aside = RewardAside::kNone;   // paper-notes
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
  // No node is expanded while the tree has more, so that its memory has a limit: kept subtrees can grow with
  // each decision. Trees of Asterix and Beam Rider had about a million with the published budget.
  std::size_t most_nodes = 4'000'000;
  // A child of the root whose kept subtree has this many nodes is left out of a search; 0: none is left out
  // (paper-notes).
  std::size_t full_branch = 0;
};

class TreeSearch {
 public:
  TreeSearch(Model& model, const TreeSettings& settings, std::uint64_t seed);

  // Searches from `root`, and returns the action with the largest discounted sum of rewards. Continues the
  // tree that keep() has left, if there is one.
  int choose(const Model::State& root);

  // Called after choose(), with the action that was taken and the state that it led to. With `reuse_tree`,
  // keeps the subtree of the action for the next choose(), if it begins with that state.
  void keep(int action, const Model::State& state);

  void forget() { kept_ = false; }

  std::size_t nodes() const { return nodes_.size(); }  // of the tree
  double value(int action) const;                      // of the root's child; 0 without a child
  std::int64_t frames() const { return frames_; }      // of the last search

  // Write and read what persists between searches, for checkpoints. read() throws InvalidInput for bytes that
  // write() cannot have written.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  using Number = std::uint32_t;
  struct Node {
    Model::State state = nullptr;  // null: the node is never expanded
    std::uint64_t hash = 0;
    Number parent = 0;
    Number first_child = 0;  // all children stand together; 0: it has not been expanded
    Number twin = 0;         // the sibling in the same state, which is expanded for both; 0: none
    int action = 0;
    std::int32_t frames = 0;  // of the action
    bool over = false;
    bool opened = false;  // it was novel when it was made or examined, so that it is to be expanded
    bool full = false;    // a child of the root that is not opened, because of settings_.full_branch
    double reward = 0;
    double best = 0;  // the largest value of a child: reward + discount * best
  };

  void begin(const Model::State& root);
  Number next_open();
  void mark_full_branches();
  void visit(Number number);
  void expand(Number parent);
  void add_child(Number parent, int action, Number first_sibling);
  void find_twin(Node& child, Number first_sibling) const;
  Number twin_of(const Node& child, Number first_sibling) const;
  bool is_put_aside(const Node& node, bool known) const;
  void look_again(Node& node);
  bool is_novel();  // whether the model's state has a byte that this search has not seen
  double value(const Node& child) const { return child.reward + settings_.discount * child.best; }
  void back_up();
  int best_action();
  Number child_of_root(int action) const;  // 0 if the root lacks it
  void move_root(Number to);

  Model& model_;
  const TreeSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::vector<Node> nodes_;          // parents precede children; the children of a node follow its siblings
  bool kept_ = false;                // keep() has left the nodes for the next tree
  std::deque<Number> open_, aside_;  // nodes to visit; those to visit after all others (reward_aside)
  std::vector<bool> seen_;           // the novelty table: the values of each feature that were seen
  std::vector<int> order_;           // the order of the actions at a node, drawn from the one before
  std::int64_t frames_ = 0;
};

}  // namespace racebeam

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
  std::int64_t frames = 133000;  // of a decision: no node is expanded after so many
  double discount = 0.999;
  bool merge_duplicates = false;  // paper-notes: of siblings in the same state one is expanded
  bool needs_novelty = false;     // IW(1)
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
};

class TreeSearch {
 public:
  TreeSearch(Model& model, const TreeSettings& settings, std::uint64_t seed);

  // The action with the largest discounted sum of rewards.
  int choose(const Model::State& root);

  std::size_t nodes() const { return nodes_.size(); }  // of the last search
  double value(int action) const;                      // of the root's child; 0: it has none
  std::int64_t frames() const { return frames_; }      // of the last search

  // What goes on from search to search, for checkpoints. read() throws InvalidInput for what write() cannot
  // have written.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  struct Node {
    Model::State state = nullptr;  // empty: it need not be expanded, or has been
    std::uint64_t hash = 0;
    std::uint32_t parent = 0;
    int action = 0;
    double reward = 0;
    double best = 0;           // over the children: reward + discount * value
    std::uint32_t chosen = 0;  // the child that gives it; 0: no child
    std::uint32_t twin = 0;    // the sibling in the same state, which is expanded for both; 0: none
  };

  void expand(std::uint32_t parent);
  void add_child(std::uint32_t parent, int action, std::size_t first_sibling);
  std::uint32_t twin_of(const Node& child, std::size_t first_sibling) const;
  bool is_new();  // whether the model's place has a byte that was not seen in this search
  void back_up();

  Model& model_;
  const TreeSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::vector<Node> nodes_;         // a parent before its children
  std::deque<std::uint32_t> open_;  // to be expanded
  std::vector<bool> seen_;          // of each byte of the features, each value
  std::vector<int> order_;          // of the actions at a node; each draw begins with the one before
  std::int64_t frames_ = 0;
};

}  // namespace racebeam

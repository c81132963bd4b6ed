// UCT: Monte-Carlo tree search that selects actions by UCB1, with random rollouts below its leaves. Bellemare
// et al. 2013, appendix B; Kocsis and Szepesvari 2006. docs/paper-notes.md says where the printed algorithm
// is wrong.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "agents/base/random.hpp"
#include "agents/base/reward_scale.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/planning/model.hpp"

namespace racebeam {

// Defaults: the paper, appendix C, where not said otherwise.
struct UctSettings {
  int simulations = 500;     // visits of the root, those that were kept from the decision before included
  int depth = 60;            // decisions from the root: 300 frames
  double exploration = 0.1;  // C
  double discount = 0.999;
  bool merge_duplicates = true;                    // section 3.2.1: siblings in the same state are one
  RewardScale reward_scale = RewardScale::kFirst;  // paper-notes
};

class Uct {
 public:
  struct Node {
    Model::State state;
    std::uint64_t hash = 0;
    Node* parent = nullptr;
    int action = 0;     // the one that led here
    double reward = 0;  // of that action
    bool over = false;  // the episode ends here
    std::int64_t visits = 0;
    double mean = 0;                              // of the returns, `reward` included
    std::vector<int> untried;                     // actions without a child
    std::vector<std::unique_ptr<Node>> children;  // of distinct states, if duplicates are merged
  };

  Uct(Model& model, const UctSettings& settings, std::uint64_t seed);

  // Searches from `root`, and returns the action that was taken most often. Continues the tree that keep()
  // has left, if there is one.
  int choose(const Model::State& root);

  // Called after choose(), with the action that was taken and the state that it led to. Keeps the subtree of
  // the action for the next choose(), if it begins with that state.
  void keep(int action, const Model::State& state);

  void forget() { root_.reset(); }

  const Node* root() const { return root_.get(); }  // null: none
  std::size_t nodes() const;                        // of the tree
  std::int64_t frames() const { return frames_; }   // of the last search

  // Write and read what persists between searches, for checkpoints.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  std::unique_ptr<Node> make_node();
  void simulate();
  Node* expand(Node& node);
  Node& select(Node& node) const;
  double rollout(int steps);
  static void update(Node* node, double value, double discount);
  const Node& most_visited();

  Model& model_;
  const UctSettings settings_;
  Random random_;
  RewardScaler scaled_;
  std::unique_ptr<Node> root_;
  std::int64_t frames_ = 0;
};

}  // namespace racebeam

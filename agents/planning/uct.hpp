// UCT: a search tree that grows where it is promising, with random play below its leaves. Bellemare et al.
// 2013, appendix B; Kocsis and Szepesvari 2006. docs/paper-notes.md says where the printed algorithm is
// wrong.
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
  int simulations = 500;     // visits of the root, with those kept from the decision before
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
    int action = 0;     // that led here
    double reward = 0;  // on the way here
    bool over = false;  // the episode ends here
    std::int64_t visits = 0;
    double mean = 0;                              // of the returns, with the reward on the way here
    std::vector<int> untried;                     // actions
    std::vector<std::unique_ptr<Node>> children;  // of distinct states, if duplicates are merged
  };

  Uct(Model& model, const UctSettings& settings, std::uint64_t seed);

  // The action that was taken most often. Begins with the tree that keep() left, if there is one.
  int choose(const Model::State& root);

  // After choose(): the subtree of `action` is the next tree, if its root has the state to which the
  // world went.
  void keep(int action, const Model::State& state);

  void forget() { root_.reset(); }

  const Node* root() const { return root_.get(); }  // null: none
  std::size_t nodes() const;                        // of the tree
  std::int64_t frames() const { return frames_; }   // of the last search

  // What goes on from search to search, for checkpoints.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  std::unique_ptr<Node> make_node();
  void simulate();
  Node* grow(Node& node);
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

#include "agents/planning/rollout_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "agents/planning/count_nodes.hpp"

namespace racebeam {

int RolloutSearch::choose(const Model::State& root) {
  const std::int64_t before = model_.frames();
  end_ = before + settings_.frames;
  ++search_;
  model_.enter(root);
  if (!root_) root_ = make_node();
  root_->state = root;
  depths_.assign(root_->features.size() * kByteValues, std::numeric_limits<int>::max());
  is_novel(*root_, 0);
  root_->solved = root_->over;
  count_ = nodes();
  while (!root_->solved && may_expand()) roll_out();
  frames_ = model_.frames() - before;
  return best_action();
}

void RolloutSearch::keep(int action, const Model::State& state) {
  std::unique_ptr<Node> next;
  if (settings_.reuse_tree && root_ && !root_->children.empty())
    next = std::move(root_->children[static_cast<std::size_t>(action)]);
  root_.reset();
  if (!next || next->over || !model_.equal(next->state, state)) return;
  next->parent = nullptr;
  root_ = std::move(next);
}

// Makes a node of the model's state.
std::unique_ptr<RolloutSearch::Node> RolloutSearch::make_node() const {
  auto node = std::make_unique<Node>();
  node->over = model_.over();
  if (!node->over) node->state = model_.save();
  const auto features = model_.features();
  node->features.assign(features.begin(), features.end());
  return node;
}

// Descends from the root by actions that are not solved, until a node is not novel, or no node may be added.
void RolloutSearch::roll_out() {
  Node* node = root_.get();
  for (int depth = 1;; ++depth) {
    const std::size_t action = open_action(*node);
    if (node->children.empty()) node->children.resize(static_cast<std::size_t>(model_.actions()));
    Node* child = node->children[action].get();
    if (!child) {
      if (!may_expand()) return back_up(node);
      child = expand(*node, action);
    }
    if (!is_novel(*child, depth)) {
      solve(child);
      return back_up(node);
    }
    node = child;
  }
}

RolloutSearch::Node* RolloutSearch::expand(Node& node, std::size_t action) {
  model_.enter(node.state);
  const double reward = scaled_(model_.act(static_cast<int>(action)));
  node.children[action] = make_node();
  ++count_;
  Node* const child = node.children[action].get();
  child->parent = &node;
  child->reward = reward;
  return child;
}

// Draws an action below which something may be novel. Nodes that an earlier search solved are open again
// until this search comes to them.
std::size_t RolloutSearch::open_action(const Node& node) {
  std::vector<std::size_t> open;
  for (std::size_t action = 0; action < static_cast<std::size_t>(model_.actions()); ++action) {
    const Node* const child = node.children.empty() ? nullptr : node.children[action].get();
    if (!child || !child->solved || child->search != search_) open.push_back(action);
  }
  return open[random_.below(open.size())];
}

// Whether the node is novel: one of its features has a value that was not seen nearer to the root. If this
// search comes to the node for the first time, the value must not have been seen at this depth either. A node
// at the end of an episode is not novel.
bool RolloutSearch::is_novel(Node& node, int depth) {
  const bool first = std::exchange(node.search, search_) != search_;
  if (first) node.solved = false;
  if (node.over) return false;
  bool found = false;
  for (std::size_t i = 0; i < node.features.size(); ++i) {
    int& least = depths_[i * kByteValues + node.features[i]];
    found |= first ? depth < least : depth <= least;
    least = std::min(least, depth);
  }
  return found;
}

// A node is solved if all of its actions lead to solved nodes.
void RolloutSearch::solve(Node* node) {
  const std::int64_t search = node->search;
  const auto is_solved = [search](const std::unique_ptr<Node>& child) {
    return child && child->solved && child->search == search;
  };
  node->solved = true;
  for (node = node->parent; node && std::ranges::all_of(node->children, is_solved); node = node->parent)
    node->solved = true;
}

void RolloutSearch::back_up(Node* node) const {
  for (; node; node = node->parent) {
    double best = -std::numeric_limits<double>::infinity();
    for (const auto& child : node->children)
      if (child) best = std::max(best, value(*child));
    node->best = std::isinf(best) ? 0 : best;
  }
}

// Draws one of the best actions, if possible one that does not end the episode.
int RolloutSearch::best_action() {
  std::vector<int> best;
  std::pair<double, bool> highest;
  for (std::size_t action = 0; action < root_->children.size(); ++action) {
    const Node* const child = root_->children[action].get();
    if (!child) continue;
    const std::pair rank(value(*child), !child->over);
    if (!best.empty() && rank < highest) continue;
    if (best.empty() || rank > highest) best.clear();
    highest = rank;
    best.push_back(static_cast<int>(action));
  }
  if (best.empty()) return static_cast<int>(random_.below(static_cast<std::size_t>(model_.actions())));
  return best[random_.below(best.size())];
}

std::size_t RolloutSearch::nodes() const { return count_nodes(root_.get()); }

double RolloutSearch::value(int action) const {
  if (!root_ || root_->children.empty()) return 0;
  const Node* const child = root_->children[static_cast<std::size_t>(action)].get();
  return child ? value(*child) : 0;
}

void RolloutSearch::write(StateWriter& out) const {
  out.put(random_);
  out.put(scaled_);
}

void RolloutSearch::read(StateReader& in) {
  in.get(random_);
  in.get(scaled_);
}

}  // namespace racebeam

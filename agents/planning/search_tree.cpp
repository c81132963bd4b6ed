#include "agents/planning/search_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace racebeam {
namespace {

constexpr std::size_t kByteValues = 256;

}  // namespace

TreeSearch::TreeSearch(Model& model, const TreeSettings& settings, std::uint64_t seed)
    : model_(model),
      settings_(settings),
      random_(seed),
      scaled_(settings.reward_scale),
      order_(static_cast<std::size_t>(model.actions())) {
  std::iota(order_.begin(), order_.end(), 0);
}

int TreeSearch::choose(const Model::State& root) {
  const std::int64_t before = model_.frames();
  nodes_.clear();
  nodes_.push_back({.state = root});
  open_.assign(1, 0);
  model_.enter(root);
  seen_.assign(model_.features().size() * kByteValues, false);
  is_new();
  while (!open_.empty() && model_.frames() - before < settings_.frames) {
    const std::uint32_t next = open_.front();
    open_.pop_front();
    expand(next);
  }
  frames_ = model_.frames() - before;
  back_up();
  for (Node& node : nodes_) node.state = nullptr;
  return nodes_[0].chosen == 0 ? order_[0] : nodes_[nodes_[0].chosen].action;
}

void TreeSearch::write(StateWriter& out) const {
  out.put(random_);
  out.put(scaled_);
  out.put(order_);
}

void TreeSearch::read(StateReader& in) {
  in.get(random_);
  in.get(scaled_);
  std::vector<int> order;
  in.get(order);
  if (!std::ranges::is_permutation(order, order_)) throw InvalidInput("its order of actions is none");
  order_ = order;
}

double TreeSearch::value(int action) const {
  for (const Node& node : nodes_)
    if (&node != &nodes_[0] && node.parent == 0 && node.action == action)
      return node.reward + settings_.discount * node.best;
  return 0;
}

// The order is drawn anew at each node: where frames end in the middle of a level, no action is preferred.
void TreeSearch::expand(std::uint32_t parent) {
  const Model::State state = std::exchange(nodes_[parent].state, nullptr);
  for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random_.below(i)]);
  const std::size_t first_sibling = nodes_.size();
  for (const int action : order_) {
    model_.enter(state);
    add_child(parent, action, first_sibling);
  }
}

void TreeSearch::add_child(std::uint32_t parent, int action, std::size_t first_sibling) {
  Node child{.parent = parent, .action = action};
  child.reward = scaled_(model_.act(action));
  if (!model_.over() && (!settings_.needs_novelty || is_new())) {
    child.state = model_.save();
    if (settings_.merge_duplicates) {
      child.hash = model_.hash(child.state);
      child.twin = twin_of(child, first_sibling);
      if (child.twin != 0) child.state = nullptr;
    }
  }
  if (child.state) open_.push_back(static_cast<std::uint32_t>(nodes_.size()));
  nodes_.push_back(std::move(child));
}

std::uint32_t TreeSearch::twin_of(const Node& child, std::size_t first_sibling) const {
  for (std::size_t i = first_sibling; i < nodes_.size(); ++i) {
    const Node& other = nodes_[i];
    if (other.state && other.hash == child.hash && model_.equal(other.state, child.state))
      return static_cast<std::uint32_t>(i);
  }
  return 0;
}

bool TreeSearch::is_new() {
  const auto features = model_.features();
  bool found = false;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::size_t place = i * kByteValues + features[i];
    if (seen_[place]) continue;
    seen_[place] = true;
    found = true;
  }
  return found;
}

// Children come behind their parents and their parents' siblings, so that one way back is enough. Of equal
// children the first one drawn stays.
void TreeSearch::back_up() {
  for (std::size_t i = nodes_.size() - 1; i > 0; --i) {
    if (nodes_[i].twin != 0) nodes_[i].best = nodes_[nodes_[i].twin].best;
    Node& parent = nodes_[nodes_[i].parent];
    const double value = nodes_[i].reward + settings_.discount * nodes_[i].best;
    if (parent.chosen == 0 || value >= parent.best) {
      parent.best = value;
      parent.chosen = static_cast<std::uint32_t>(i);
    }
  }
}

}  // namespace racebeam

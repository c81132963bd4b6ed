#include "agents/planning/search_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace racebeam {

TreeSearch::TreeSearch(Model& model, const TreeSettings& settings, std::uint64_t seed)
    : model_(model),
      settings_(settings),
      random_(seed),
      scaled_(settings.reward_scale),
      order_(static_cast<std::size_t>(model.actions())) {
  std::iota(order_.begin(), order_.end(), 0);
}

int TreeSearch::choose(const Model::State& root) {
  begin(root);
  // Breadth-first search limits the frames of the tree, and IW(1) those of one search.
  std::int64_t spent = -model_.frames();
  if (!settings_.needs_novelty)
    for (const Node& node : nodes_) spent += node.frames;
  frames_ = -model_.frames();
  while (!(open_.empty() && aside_.empty()) && model_.frames() + spent < settings_.frames &&
         nodes_.size() <= settings_.most_nodes)
    visit(next_open());
  frames_ += model_.frames();
  back_up();
  return best_action();
}

void TreeSearch::keep(int action, const Model::State& state) {
  forget();
  const Number child = child_of_root(action);
  const Number twin = child == 0 || nodes_[child].twin == 0 ? child : nodes_[child].twin;
  if (!settings_.reuse_tree || twin == 0 || !nodes_[twin].state || !model_.equal(nodes_[twin].state, state))
    return;
  move_root(twin);
  nodes_[0].state = state;
  kept_ = true;
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
  if (!std::ranges::is_permutation(order, order_)) throw InvalidInput("its order of actions is invalid");
  order_ = order;
}

double TreeSearch::value(int action) const {
  const Number child = child_of_root(action);
  return child == 0 ? 0 : value(nodes_[child]);
}

// The root of a kept tree has its place in it as the reused nodes have theirs: it is not looked at again.
void TreeSearch::begin(const Model::State& root) {
  open_.assign(1, 0);
  aside_.clear();
  model_.enter(root);
  seen_.assign(model_.features().size() * kByteValues, false);
  if (std::exchange(kept_, false)) return mark_full_branches();
  nodes_.clear();
  nodes_.push_back({.state = root});
  is_novel();
}

void TreeSearch::mark_full_branches() {
  const Number first = nodes_[0].first_child;
  if (settings_.full_branch == 0 || first == 0) return;
  std::vector<Number> sizes(nodes_.size(), 1);  // of the subtrees
  for (std::size_t i = nodes_.size() - 1; i > 0; --i) sizes[nodes_[i].parent] += sizes[i];
  for (Number child = first; child < first + order_.size(); ++child)
    nodes_[child].full = sizes[child] >= settings_.full_branch;
}

TreeSearch::Number TreeSearch::next_open() {
  std::deque<Number>& queue = open_.empty() ? aside_ : open_;
  const Number next = queue.front();
  queue.pop_front();
  return next;
}

void TreeSearch::visit(Number number) {
  const bool reused = nodes_[number].first_child != 0;
  if (!reused) expand(number);
  const Number first = nodes_[number].first_child;
  for (Number child = first; child < first + order_.size(); ++child) {
    Node& node = nodes_[child];
    const bool known = reused && node.opened;  // to a search before
    if (reused) look_again(node);
    if (node.opened && !node.full) (is_put_aside(node, known) ? aside_ : open_).push_back(child);
  }
}

bool TreeSearch::is_put_aside(const Node& node, bool known) const {
  switch (settings_.reward_aside) {
    case RewardAside::kNone: return false;
    case RewardAside::kNew: return node.reward > 0 && !known;
    case RewardAside::kAll: return node.reward != 0;
  }
  return false;
}

// Draws the order of the actions anew at each node, so that no action is preferred if the frames are used up
// within a level.
void TreeSearch::expand(Number parent) {
  const Model::State state =
      settings_.reuse_tree ? nodes_[parent].state : std::exchange(nodes_[parent].state, nullptr);
  for (std::size_t i = order_.size(); i > 1; --i) std::swap(order_[i - 1], order_[random_.below(i)]);
  const auto first_child = nodes_[parent].first_child = static_cast<Number>(nodes_.size());
  for (const int action : order_) {
    model_.enter(state);
    add_child(parent, action, first_child);
  }
}

void TreeSearch::add_child(Number parent, int action, Number first_sibling) {
  Node child{.parent = parent, .action = action};
  const std::int64_t before = model_.frames();
  child.reward = scaled_(model_.act(action));
  child.frames = static_cast<std::int32_t>(model_.frames() - before);
  child.over = model_.over();
  child.opened = !child.over && (!settings_.needs_novelty || is_novel());
  if (child.opened || (settings_.reuse_tree && !child.over)) child.state = model_.save();
  if (child.state) find_twin(child, first_sibling);
  nodes_.push_back(std::move(child));
}

// Siblings in equal states share one, so that it takes memory only once. If duplicates are merged, only the
// first of these siblings is expanded.
void TreeSearch::find_twin(Node& child, Number first_sibling) const {
  child.hash = model_.hash(child.state);
  const Number twin = twin_of(child, first_sibling);
  if (twin == 0) return;
  child.state = settings_.merge_duplicates ? nullptr : nodes_[twin].state;
  if (!settings_.merge_duplicates) return;
  child.twin = twin;
  child.opened = false;
}

TreeSearch::Number TreeSearch::twin_of(const Node& child, Number first_sibling) const {
  for (Number i = first_sibling; i < nodes_.size(); ++i) {
    const Node& other = nodes_[i];
    if (other.state && other.hash == child.hash && model_.equal(other.state, child.state)) return i;
  }
  return 0;
}

// Examines a reused node: one that was not novel in an earlier search can be novel in this one.
void TreeSearch::look_again(Node& node) {
  if (node.opened || !node.state) return;
  model_.enter(node.state);
  node.opened = is_novel();
}

bool TreeSearch::is_novel() {
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

// One pass from the last node to the first suffices, because the children of a twin follow all of its
// siblings.
void TreeSearch::back_up() {
  const double none = -std::numeric_limits<double>::infinity();
  for (Node& node : nodes_) node.best = node.first_child == 0 ? 0 : none;
  for (std::size_t i = nodes_.size() - 1; i > 0; --i) {
    if (nodes_[i].twin != 0) nodes_[i].best = nodes_[nodes_[i].twin].best;
    Node& parent = nodes_[nodes_[i].parent];
    parent.best = std::max(parent.best, value(nodes_[i]));
  }
}

// Draws one of the best actions, if possible one that does not end the episode.
int TreeSearch::best_action() {
  const Number first = nodes_[0].first_child;
  if (first == 0) return order_[random_.below(order_.size())];
  const auto rank = [this](Number child) { return std::pair(value(nodes_[child]), !nodes_[child].over); };
  std::vector<Number> best;
  for (Number child = first; child < first + order_.size(); ++child) {
    if (!best.empty() && rank(child) < rank(best[0])) continue;
    if (!best.empty() && rank(child) > rank(best[0])) best.clear();
    best.push_back(child);
  }
  return nodes_[best[random_.below(best.size())]].action;
}

TreeSearch::Number TreeSearch::child_of_root(int action) const {
  if (nodes_.empty() || nodes_[0].first_child == 0) return 0;
  Number child = nodes_[0].first_child;
  while (nodes_[child].action != action) ++child;
  return child;
}

// Drops all nodes but those of the subtree of `to`, which keep their order. The root is as in a new tree, but
// has its children.
void TreeSearch::move_root(Number to) {
  std::vector<Number> number_of(nodes_.size());  // 0: it is dropped, or is the new root
  std::vector<Node> nodes;
  nodes.push_back({.first_child = nodes_[to].first_child});
  for (Number number = to + 1; number < nodes_.size(); ++number) {
    const Number parent = nodes_[number].parent;
    if (parent != to && number_of[parent] == 0) continue;
    number_of[number] = static_cast<Number>(nodes.size());
    Node& node = nodes.emplace_back(std::move(nodes_[number]));
    node.parent = number_of[parent];
    node.twin = number_of[node.twin];
    Number& first_child = nodes[node.parent].first_child;
    if (first_child == number) first_child = number_of[number];
  }
  nodes_ = std::move(nodes);
}

}  // namespace racebeam

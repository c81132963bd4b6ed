#include "agents/planning/uct.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "agents/planning/count_nodes.hpp"

namespace racebeam {

Uct::Uct(Model& model, const UctSettings& settings, std::uint64_t seed)
    : model_(model), settings_(settings), random_(seed), scaled_(settings.reward_scale) {}

int Uct::choose(const Model::State& root) {
  const std::int64_t before = model_.frames();
  model_.enter(root);
  if (!root_) {
    root_ = make_node();
    root_->state = root;
  }
  while (!root_->over && (root_->visits < settings_.simulations || root_->children.empty())) simulate();
  frames_ = model_.frames() - before;
  if (root_->over) return static_cast<int>(random_.below(static_cast<std::size_t>(model_.actions())));
  return most_visited().action;
}

void Uct::keep(int action, const Model::State& state) {
  if (!root_) return;
  const auto found =
      std::ranges::find(root_->children, action, [](const auto& child) { return child->action; });
  if (found == root_->children.end() || (*found)->over || !model_.equal((*found)->state, state)) {
    root_.reset();
    return;
  }
  std::unique_ptr<Node> next = std::move(*found);
  next->parent = nullptr;
  next->state = state;
  root_ = std::move(next);
}

// Makes a node of the model's state.
std::unique_ptr<Uct::Node> Uct::make_node() {
  auto node = std::make_unique<Node>();
  node->over = model_.over();
  if (node->over) return node;
  node->untried.resize(static_cast<std::size_t>(model_.actions()));
  std::iota(node->untried.begin(), node->untried.end(), 0);
  return node;
}

// Descends to a leaf, a node without visits, plays a rollout from there, and updates the nodes on the path.
void Uct::simulate() {
  Node* node = root_.get();
  int depth = 0;
  while (node->visits > 0 && !node->over && depth < settings_.depth) {
    Node* const grown = expand(*node);
    node = grown ? grown : &select(*node);
    ++depth;
  }
  const double value = node->over ? 0 : rollout(settings_.depth - depth);  // the model is at a new leaf
  update(node, value, settings_.discount);
}

// Expands the node by an action that was not tried. Returns the child, whose state the model then has.
// Returns null if all actions were tried; actions that lead to the state of a sibling get no child.
Uct::Node* Uct::expand(Node& node) {
  while (!node.untried.empty()) {
    std::swap(node.untried[random_.below(node.untried.size())], node.untried.back());
    const int action = node.untried.back();
    node.untried.pop_back();
    model_.enter(node.state);
    const double reward = scaled_(model_.act(action));
    auto child = make_node();
    child->parent = &node;
    child->action = action;
    child->reward = reward;
    child->state = model_.save();
    if (settings_.merge_duplicates) {
      child->hash = model_.hash(child->state);
      const auto twin = [&](const auto& other) {
        return other->hash == child->hash && other->reward == child->reward && other->over == child->over &&
               model_.equal(other->state, child->state);
      };
      if (std::ranges::any_of(node.children, twin)) continue;
    }
    node.children.push_back(std::move(child));
    return node.children.back().get();
  }
  return nullptr;
}

// Selects the child with the largest UCB1; of equal ones the first, since their order was drawn.
Uct::Node& Uct::select(Node& node) const {
  const double logarithm = std::log(static_cast<double>(node.visits));
  const auto bound = [&](const auto& child) {
    return child->mean + settings_.exploration * std::sqrt(logarithm / static_cast<double>(child->visits));
  };
  return **std::ranges::max_element(node.children, {}, bound);
}

double Uct::rollout(int steps) {
  double sum = 0, discount = 1;
  for (; steps > 0 && !model_.over(); --steps, discount *= settings_.discount)
    sum += discount *
           scaled_(model_.act(static_cast<int>(random_.below(static_cast<std::size_t>(model_.actions())))));
  return sum;
}

// Updates the node and those above it. value: the return of what follows the node.
void Uct::update(Node* node, double value, double discount) {
  for (; node != nullptr; node = node->parent) {
    value = node->reward + discount * value;
    ++node->visits;
    node->mean += (value - node->mean) / static_cast<double>(node->visits);
  }
}

// Returns the child with the most visits; of equal ones that with the largest mean, and of these the first,
// since their order was drawn.
const Uct::Node& Uct::most_visited() {
  return **std::ranges::max_element(root_->children, [](const auto& a, const auto& b) {
    return a->visits != b->visits ? a->visits < b->visits : a->mean < b->mean;
  });
}

void Uct::write(StateWriter& out) const {
  out.put(random_);
  out.put(scaled_);
}

void Uct::read(StateReader& in) {
  in.get(random_);
  in.get(scaled_);
}

std::size_t Uct::nodes() const { return count_nodes(root_.get()); }

}  // namespace racebeam

#include "agents/learning/sarsa.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace racebeam {
namespace {

using Doubles [[gnu::vector_size(16)]] = double;
using Floats [[gnu::vector_size(8)]] = float;

}  // namespace

Sarsa::Sarsa(const SarsaSettings& settings, std::size_t features, std::uint64_t seed, int actions)
    : settings_(settings),
      actions_(static_cast<std::size_t>(actions)),
      weights_(features * actions_),
      where_(settings.clear_other_traces ? features : features * actions_),
      scaled_(settings.reward_scale),
      random_(seed) {}

int Sarsa::begin(const ActiveFeatures& features) {
  clear_traces();
  compute_values(features);
  action_ = choose();
  features_ = features;
  return action_;
}

int Sarsa::next(double reward, const ActiveFeatures& features) {
  const double scaled_reward = scaled_(reward);
  if (learning_) replace_traces();
  const double before = learning_ ? value(features_, action_) : 0;
  compute_values(features);
  const int action = choose();
  if (learning_)
    update(scaled_reward + settings_.discount * values_[static_cast<std::size_t>(action)] - before);
  features_ = features;
  return action_ = action;
}

void Sarsa::end(double reward) {
  const double scaled_reward = scaled_(reward);
  if (!learning_) return;
  replace_traces();
  update(scaled_reward - value(features_, action_));
  clear_traces();
}

double Sarsa::value(const ActiveFeatures& features, int action) const {
  double sum = 0;
  for (std::size_t i = 0; i < features.indices.size(); ++i)
    sum += double{features.count(i)} * double{weights_[place(features.indices[i], action)]};
  return sum;
}

// The sums of all actions at once, each in the order of the features.
void Sarsa::compute_values(const ActiveFeatures& features) {
  if (actions_ == kActions && features.counts.empty()) return compute_binary_values(features);
  Values sums{};
  for (std::size_t i = 0; i < features.indices.size(); ++i) {
    const float* const weights = weights_.data() + place(features.indices[i], 0);
    const double count = features.count(i);
    for (std::size_t action = 0; action < actions_; ++action) sums[action] += count * double{weights[action]};
  }
  values_ = sums;
}

// The same for counts of 1 and 18 actions, two at a time: the sums stay in registers, as a loop over actions
// would not keep them.
void Sarsa::compute_binary_values(const ActiveFeatures& features) {
  std::array<Doubles, kActions / 2> sums{};
  for (const std::uint32_t feature : features.indices) {
    const float* const weights = weights_.data() + std::size_t{feature} * kActions;
    for (std::size_t pair = 0; pair < sums.size(); ++pair) {
      Floats two;
      std::memcpy(&two, weights + 2 * pair, sizeof two);
      sums[pair] += __builtin_convertvector(two, Doubles);
    }
  }
  std::memcpy(values_.data(), sums.data(), sizeof sums);
}

// Of actions with equal values, each is as likely.
int Sarsa::choose() {
  if (random_.uniform() < (learning_ ? settings_.exploration : settings_.evaluation_exploration))
    return static_cast<int>(random_.below(actions_));
  const double best =
      *std::max_element(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(actions_));
  std::array<int, kActions> equal{};
  std::size_t count = 0;
  for (std::size_t action = 0; action < actions_; ++action)
    if (values_[action] == best) equal[count++] = static_cast<int>(action);
  if (count == 0) diverged_ = true;  // not a number
  return count <= 1 ? equal[0] : equal[random_.below(count)];
}

double Sarsa::trace(std::size_t feature, int action) const {
  const std::uint32_t number = where_[owner(feature, action)];
  if (number == 0 || traces_[number - 1].place != place(feature, action)) return 0;
  return double{traces_[number - 1].size};
}

void Sarsa::replace_traces() {
  for (std::size_t i = 0; i < features_.indices.size(); ++i) {
    const std::size_t feature = features_.indices[i];
    const auto at = static_cast<std::uint32_t>(place(feature, action_));
    const auto own = static_cast<std::uint32_t>(owner(feature, action_));
    const Trace trace{at, own, features_.count(i)};
    if (where_[own] != 0) {
      traces_[where_[own] - 1] = trace;
    } else {
      traces_.push_back(trace);
      where_[own] = static_cast<std::uint32_t>(traces_.size());
    }
  }
}

// Moves the weights along their traces, which then decay.
void Sarsa::update(double error) {
  most_active_ =
      std::max(most_active_, features_.counts.empty()
                                 ? static_cast<double>(features_.indices.size())
                                 : std::accumulate(features_.counts.begin(), features_.counts.end(), 0.0));
  const double step = settings_.step_size / most_active_ * error;
  if (!std::isfinite(step)) {
    diverged_ = true;
    return;
  }
  const auto moved = static_cast<float>(step);
  const auto decay = static_cast<float>(settings_.discount * settings_.trace_decay);
  const auto least = static_cast<float>(settings_.least_trace);
  for (std::size_t i = 0; i < traces_.size();) {
    Trace& trace = traces_[i];
    weights_[trace.place] += moved * trace.size;
    trace.size *= decay;
    trace.size < least || trace.size == 0 ? drop_trace(i) : void(++i);
  }
}

// The last trace takes its place.
void Sarsa::drop_trace(std::size_t number) {
  where_[traces_[number].owner] = 0;
  if (number + 1 < traces_.size()) {
    traces_[number] = traces_.back();
    where_[traces_[number].owner] = static_cast<std::uint32_t>(number + 1);
  }
  traces_.pop_back();
}

void Sarsa::clear_traces() {
  for (const Trace& trace : traces_) where_[trace.owner] = 0;
  traces_.clear();
}

// Traces are empty between episodes.
void Sarsa::write(StateWriter& out) const {
  out.put(weights_);
  out.put(most_active_);
  out.put(scaled_);
  out.put(random_);
}

void Sarsa::read(StateReader& in) {
  const std::size_t size = weights_.size();
  in.get(weights_);
  in.get(most_active_);
  in.get(scaled_);
  in.get(random_);
  if (weights_.size() != size) throw InvalidInput("the checkpoint is of another number of features");
}

}  // namespace racebeam

#include "agents/learning/sarsa.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "agents/learning/action_sums.hpp"

namespace racebeam {
namespace {

constexpr int kFetchAhead = 24;  // features whose weights are on their way from memory

// Throws InvalidInput if a trace cannot name each weight.
std::size_t weights_of(std::size_t features, std::size_t actions) {
  const std::size_t most = std::numeric_limits<std::uint32_t>::max() / actions;
  if (features > most)
    throw InvalidInput("there are " + std::to_string(features) + " features; a learner accepts at most " +
                       std::to_string(most));
  return features * actions;
}

}  // namespace

Sarsa::Sarsa(const SarsaSettings& settings, std::size_t features, std::uint64_t seed, int actions)
    : control_(settings, static_cast<std::size_t>(actions), seed),
      actions_(control_.actions()),
      grows_(features == 0),
      weights_(weights_of(features, actions_)) {}

int Sarsa::begin(const ActiveFeatures& features) {
  traces_.clear();
  compute_values(features);
  action_ = control_.choose(values_);
  features_ = features;
  return action_;
}

int Sarsa::next(double reward, const ActiveFeatures& features) {
  const double scaled_reward = control_.scaled(reward);
  const double before = control_.is_learning() ? value(features_, action_) : 0;
  compute_values(features);
  const int action = control_.choose(values_);
  if (control_.is_learning())
    update(scaled_reward + control_.settings().discount * values_[static_cast<std::size_t>(action)] - before);
  features_ = features;
  return action_ = action;
}

void Sarsa::end(double reward) {
  const double scaled_reward = control_.scaled(reward);
  if (!control_.is_learning()) return;
  update(scaled_reward - value(features_, action_));
  traces_.clear();
}

double Sarsa::value(const ActiveFeatures& features, int action) const {
  double sum = 0;
  for (std::size_t i = 0; i < features.indices.size(); ++i) {
    fetch_weights(features, i + kFetchAhead);
    sum += double{features.count(i)} * double{weights_[place(features.indices[i], action)]};
  }
  return sum;
}

// A row of weights lies in two of the processor's lines.
void Sarsa::fetch_weights(const ActiveFeatures& features, std::size_t i) const {
  if (i >= features.indices.size()) return;
  const float* const row = weights_.data() + place(features.indices[i], 0);
  __builtin_prefetch(row);
  __builtin_prefetch(row + actions_ - 1);
}

// The sums of all actions at once, each in the order of the features.
void Sarsa::compute_values(const ActiveFeatures& features) {
  if (actions_ == kActions)
    return features.counts.empty() ? compute_all_values<false>(features) : compute_all_values<true>(features);
  ActionValues sums{};
  for (std::size_t i = 0; i < features.indices.size(); ++i) {
    const float* const weights = weights_.data() + place(features.indices[i], 0);
    const double count = features.count(i);
    for (std::size_t action = 0; action < actions_; ++action) sums[action] += count * double{weights[action]};
  }
  values_ = sums;
}

// The sums of 18 actions.
template <bool kCounted>
void Sarsa::compute_all_values(const ActiveFeatures& features) {
  ActionSums sums;
  for (std::size_t i = 0; i < features.indices.size(); ++i) {
    fetch_weights(features, i + kFetchAhead);
    const float* const weights = weights_.data() + std::size_t{features.indices[i]} * kActions;
    if constexpr (kCounted)
      sums.add(weights, double{features.counts[i]});
    else
      sums.add(weights);
  }
  values_ = sums.values();
}

double Sarsa::trace(std::size_t feature, int action) const {
  const auto found = std::ranges::lower_bound(traces_, place(feature, action), {}, &Trace::place);
  return found == traces_.end() || found->place != place(feature, action) ? 0 : double{found->size};
}

// Returns how far a step of 1 moves the value of these features.
double Sarsa::gain(const ActiveFeatures& features) {
  if (features.counts.empty()) return static_cast<double>(features.indices.size());
  return std::accumulate(features.counts.begin(), features.counts.end(), 0.0);
}

void Sarsa::update(double error) {
  if (const auto step = control_.step(error, gain(features_))) move_weights(*step);
}

// Merges the traces of features_, which replace others, into traces_. Moves each weight along its trace,
// which then decays.
void Sarsa::move_weights(float step) {
  const SarsaSettings& settings = control_.settings();
  const auto decay = static_cast<float>(settings.discount * settings.trace_decay);
  const auto least = static_cast<float>(settings.least_trace);
  merged_.resize(traces_.size() + features_.indices.size());
  Trace* out = merged_.data();
  const auto move = [&](Trace trace) {
    weights_[trace.place] += step * trace.size;
    trace.size *= decay;
    *out = trace;
    out += !(trace.size < least || trace.size == 0);
  };
  auto old = traces_.cbegin();
  const auto move_old = [&] {
    if (traces_.cend() - old > kFetchAhead) __builtin_prefetch(&weights_[old[kFetchAhead].place], 1);
    move(*old++);
  };
  for (std::size_t i = 0; i < features_.indices.size(); ++i) {
    fetch_weights(features_, i + kFetchAhead);
    const auto at = static_cast<std::uint32_t>(place(features_.indices[i], action_));
    const auto before = static_cast<std::uint32_t>(settings.clear_other_traces ? action_ : 0);
    const auto behind = static_cast<std::uint32_t>(settings.clear_other_traces ? actions_ : 1) - before;
    while (old != traces_.cend() && old->place < at - before) move_old();
    if (old != traces_.cend() && old->place < at + behind) ++old;  // is replaced
    move({at, 1.0F});
  }
  while (old != traces_.cend()) move_old();
  merged_.resize(static_cast<std::size_t>(out - merged_.data()));
  std::swap(traces_, merged_);
}

void Sarsa::refine(std::size_t groups, std::span<const FeatureSplit> splits) {
  if (groups * actions_ > weights_.size()) weights_.resize(weights_of(groups, actions_));
  for (const FeatureSplit& each : splits) split(each);
}

// The new group comes behind all others, in the traces and among the features that were active.
void Sarsa::split(const FeatureSplit& part) {
  std::copy_n(weights_.data() + place(part.from, 0), actions_, weights_.data() + place(part.to, 0));
  auto trace = static_cast<std::size_t>(
      std::ranges::lower_bound(traces_, place(part.from, 0), {}, &Trace::place) - traces_.begin());
  for (; trace < traces_.size() && traces_[trace].place < place(part.from + 1, 0); ++trace) {
    const auto [at, size] = traces_[trace];
    traces_.push_back({static_cast<std::uint32_t>(at - place(part.from, 0) + place(part.to, 0)), size});
  }
  const auto active = std::ranges::lower_bound(features_.indices, part.from);
  if (active == features_.indices.end() || *active != part.from) return;
  features_.counts[static_cast<std::size_t>(active - features_.indices.begin())] -=
      static_cast<float>(part.features);
  features_.indices.push_back(part.to);
  features_.counts.push_back(static_cast<float>(part.features));
}

// Traces are empty between episodes.
void Sarsa::write(StateWriter& out) const {
  out.put(weights_);
  control_.write(out);
}

void Sarsa::read(StateReader& in) {
  const std::size_t size = weights_.size();
  in.get(weights_);
  control_.read(in);
  if (weights_.size() != size && !grows_)
    throw InvalidInput("the checkpoint is of another number of features");
}

}  // namespace racebeam

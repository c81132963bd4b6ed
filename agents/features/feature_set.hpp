// A feature set turns a screen, or RAM, into a list of active features.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "agents/base/state_bytes.hpp"
#include "environment/environment.hpp"

namespace racebeam {

// Indices of active features, in ascending order, each once. `counts` has a number for each index: how often
// the feature occurs, or how many features share the weight of the index. It is empty if all numbers are 1.
struct ActiveFeatures {
  std::vector<std::uint32_t> indices;
  std::vector<float> counts;

  void clear() {
    indices.clear();
    counts.clear();
  }
  float count(std::size_t place) const { return counts.empty() ? 1.0F : counts[place]; }
};

class FeatureSet {
 public:
  virtual ~FeatureSet() = default;

  virtual std::size_t size() const = 0;  // the number of features; indices are less
  virtual bool reads_screen() const { return true; }

  // Replaces `active` by the features of what the machine shows. Called once for each decision.
  virtual void extract(const Environment& machine, ActiveFeatures& active) = 0;

  virtual void begin_episode() {}
};

// Returns the index of a pair, i < j, among all pairs. Each of the n (n - 1) / 2 pairs has its own.
constexpr std::uint32_t pair_index(std::uint32_t i, std::uint32_t j) { return j * (j - 1) / 2 + i; }

constexpr std::size_t pairs_of(std::size_t count) { return count * (count - 1) / 2; }

// Appends all pairs of the active features, numbered from `first`. The features must ascend.
inline void append_pairs(ActiveFeatures& active, std::uint32_t first) {
  const std::size_t count = active.indices.size();
  active.indices.resize(count + pairs_of(count));
  std::uint32_t* out = active.indices.data() + count;
  for (std::size_t j = 1; j < count; ++j) {
    const std::uint32_t base = first + pair_index(0, active.indices[j]);
    for (std::size_t i = 0; i < j; ++i) *out++ = base + active.indices[i];
  }
}

}  // namespace racebeam

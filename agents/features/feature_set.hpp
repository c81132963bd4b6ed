// A feature set turns a screen, or RAM, into a list of active features.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "agents/base/state_bytes.hpp"
#include "environment/environment.hpp"

namespace racebeam {

// Indices of features, in ascending order, each once. `counts` has as many numbers, or none if all are 1: how
// often a feature is there, or of how many features an index is that share a weight.
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

  virtual std::size_t size() const = 0;  // indices are below it
  virtual bool reads_screen() const { return true; }

  // Replaces `active` by the features of what the machine shows. Called once for each decision.
  virtual void extract(const Environment& machine, ActiveFeatures& active) = 0;

  virtual void begin_episode() {}
};

// The index of a pair, i < j, among all pairs: each of n (n - 1) / 2 is hit once.
constexpr std::uint32_t pair_index(std::uint32_t i, std::uint32_t j) { return j * (j - 1) / 2 + i; }

constexpr std::size_t pairs_of(std::size_t count) { return count * (count - 1) / 2; }

// Appends all pairs of the features that are there, numbered from `first`. The features must ascend.
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

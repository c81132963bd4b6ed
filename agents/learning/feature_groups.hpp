// Groups of features that were always active together so far. The weights of such features are equal, so that
// they share one (Liang et al. 2016). Only features that were seen take memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/base/huge_pages.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/features/feature_set.hpp"

namespace racebeam {

// `features` features have left the group `from` for the new group `to`.
struct FeatureSplit {
  std::uint32_t from, to, features;
  bool operator==(const FeatureSplit&) const = default;
};

class FeatureGroups {
 public:
  // Features beyond the first `most` that are seen are left out.
  explicit FeatureGroups(std::size_t most);

  // Replaces the features of a state by their groups, with the number of features of each. A group of which
  // only some features are active is split; the splits are valid until the next call.
  std::span<const FeatureSplit> replace(ActiveFeatures& active);

  std::size_t count() const { return sizes_.size(); }  // of groups: their numbers are below it
  std::size_t seen() const { return seen_; }           // features
  // The memory: kMinBytes; then at most kMaxSlotBytes for each feature that was seen or was active in a
  // call, and kGroupBytes for each group.
  std::size_t bytes() const;

  static constexpr std::size_t kMinBytes = 8192, kMaxSlotBytes = 32, kGroupBytes = 12;

  void write(StateWriter& out) const;
  void read(StateReader& in);  // throws InvalidInput unless write() wrote this

 private:
  using Number = std::uint32_t;

  // A place of the table: open addressing, linear probing.
  struct Slot {
    std::uint32_t feature;
    Number group;
  };

  Slot& slot_of(std::uint32_t feature);
  void make_room(std::size_t features);
  void find_groups(const std::vector<std::uint32_t>& features);
  void split_groups();
  Number add_group(std::uint32_t size);
  bool is_sound();

  std::size_t most_, seen_ = 0;
  HugeTable<Slot> slots_;              // a power of two, at most half full
  std::vector<std::uint32_t> sizes_;   // per group
  std::vector<std::uint32_t> active_;  // per group: its features that are active; 0 between calls
  std::vector<Number> successor_;      // per active group: the group of its active features
  std::vector<Slot*> found_;           // of the features that are active
  std::vector<Number> touched_;        // groups with active features
  std::vector<FeatureSplit> splits_;
};

}  // namespace racebeam

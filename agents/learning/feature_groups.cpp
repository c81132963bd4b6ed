#include "agents/learning/feature_groups.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::uint32_t kNoFeature = 0xFFFFFFFF;

}  // namespace

FeatureGroups::FeatureGroups(std::size_t most)
    : most_(most), slots_(kMinBytes / sizeof(Slot), Slot{kNoFeature, 0}) {}

std::span<const FeatureSplit> FeatureGroups::replace(ActiveFeatures& active) {
  make_room(active.indices.size());
  find_groups(active.indices);
  split_groups();
  active.clear();
  for (Number& group : touched_) group = successor_[group];
  std::ranges::sort(touched_);
  active.indices = touched_;
  for (const Number group : touched_) active.counts.push_back(static_cast<float>(sizes_[group]));
  return splits_;
}

// Fibonacci hashing (Knuth, volume 3, section 6.4).
FeatureGroups::Slot& FeatureGroups::slot_of(std::uint32_t feature) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t place = (feature * std::uint64_t{0x9E3779B97F4A7C15}) >> std::countl_zero(mask);
  while (slots_[place].feature != feature && slots_[place].feature != kNoFeature) place = (place + 1) & mask;
  return slots_[place];
}

// Makes room for this number of features that may be new.
void FeatureGroups::make_room(std::size_t features) {
  const std::size_t slots = std::bit_ceil(2 * std::min(seen_ + features, most_));
  if (slots <= slots_.size()) return;
  const HugeTable<Slot> old = std::exchange(slots_, HugeTable<Slot>(slots, Slot{kNoFeature, 0}));
  for (const Slot& slot : old)
    if (slot.feature != kNoFeature) slot_of(slot.feature) = slot;
}

// Features that are new are a group.
void FeatureGroups::find_groups(const std::vector<std::uint32_t>& features) {
  found_.clear();
  touched_.clear();
  const auto of_new = static_cast<Number>(count());
  for (const std::uint32_t feature : features) {
    Slot& slot = slot_of(feature);
    if (slot.feature == kNoFeature) {
      if (seen_ == most_) continue;
      ++seen_;
      if (count() == of_new) add_group(0);
      slot = {feature, of_new};
      ++sizes_[of_new];
    }
    if (active_[slot.group]++ == 0) touched_.push_back(slot.group);
    found_.push_back(&slot);
  }
}

void FeatureGroups::split_groups() {
  splits_.clear();
  for (const Number group : touched_) {
    const std::uint32_t active = std::exchange(active_[group], 0);
    successor_[group] = group;
    if (active == sizes_[group]) continue;
    const Number part = add_group(active);
    sizes_[group] -= active;
    successor_[group] = part;
    splits_.push_back({group, part, active});
  }
  for (Slot* const slot : found_) slot->group = successor_[slot->group];
}

FeatureGroups::Number FeatureGroups::add_group(std::uint32_t size) {
  sizes_.push_back(size);
  active_.push_back(0);
  successor_.push_back(0);
  return static_cast<Number>(count() - 1);
}

std::size_t FeatureGroups::bytes() const { return slots_.size() * sizeof(Slot) + count() * kGroupBytes; }

void FeatureGroups::write(StateWriter& out) const {
  out.put(seen_);
  out.put(slots_);
  out.put(sizes_);
}

void FeatureGroups::read(StateReader& in) {
  in.get(seen_);
  in.get(slots_);
  in.get(sizes_);
  if (!is_sound()) throw InvalidInput("its groups of features are invalid");
  active_.assign(count(), 0);
  successor_.assign(count(), 0);
}

// Whether the table can be searched, and each group has the features that the table says.
bool FeatureGroups::is_sound() {
  if (!std::has_single_bit(slots_.size()) || slots_.size() < kMinBytes / sizeof(Slot)) return false;
  if (seen_ > std::min(most_, slots_.size() / 2)) return false;
  std::size_t seen = 0;
  std::vector<std::uint32_t> sizes(count());
  for (const Slot& slot : slots_) {
    if (slot.feature == kNoFeature && slot.group == 0) continue;
    if (slot.feature == kNoFeature || slot.group >= count()) return false;
    ++seen;
    ++sizes[slot.group];
  }
  const auto is_found = [&](const Slot& slot) {
    return slot.feature == kNoFeature || &slot_of(slot.feature) == &slot;
  };
  return seen == seen_ && sizes == sizes_ && std::ranges::all_of(slots_, is_found);
}

}  // namespace racebeam

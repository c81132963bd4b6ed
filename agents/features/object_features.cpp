#include "agents/features/object_features.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <tuple>
#include <utility>

namespace racebeam {
namespace {

constexpr int kMostInstances = 50;        // of a class; paper-notes
constexpr std::uint32_t kApproaches = 4;  // not at all, in x, in y, in both

bool approach(int distance, int velocity) {
  return (distance > 0 && velocity < 0) || (distance < 0 && velocity > 0);
}

}  // namespace

InstanceFinder::InstanceFinder(const Background& background, const ObjectClasses& classes)
    : objects_(background) {
  for (std::uint32_t number = 0; number < classes.size(); ++number)
    for (const Shape& shape : classes[number])
      for (int mirror = 0; mirror < kMirrors; ++mirror)
        class_of_.emplace(key_of(mirrored(shape, mirror)), number);
}

const std::vector<Instance>& InstanceFinder::find(Screen screen) {
  instances_.clear();
  objects_.see(screen);
  for (const ScreenObject& object : objects_.objects().all()) {
    if (add(object)) continue;
    for (std::uint32_t part = 0; part < object.part_count; ++part)
      add(objects_.part(object.first_part + part));
  }
  std::ranges::stable_sort(instances_, std::ranges::greater{}, &Instance::area);
  std::array<int, kMostClasses> count{};
  std::erase_if(instances_,
                [&](const Instance& instance) { return ++count[instance.class_number] > kMostInstances; });
  return instances_;
}

// Returns whether the object's shape is of a class.
bool InstanceFinder::add(const ScreenObject& object) {
  const auto found = class_of_.find(object.key);
  if (found == class_of_.end()) return false;
  instances_.push_back({found->second, object.area, object.box, object.velocity.value_or(Velocity{0, 0})});
  return true;
}

ObjectFeatures::ObjectFeatures(const Background& background, const ObjectClasses& classes, int tilings,
                               int grid)
    : finder_(background, classes),
      places_(kFeatureWidth, kFeatureHeight, tilings, grid),
      distances_(2 * kFeatureWidth - 1, 2 * kFeatureHeight - 1, tilings, grid),
      classes_(static_cast<std::uint32_t>(classes.size())),
      first_place_(classes_),
      first_pair_(first_place_ + classes_ * places_.size()),
      counts_(first_pair_ + pairs_of(classes_) * kApproaches * distances_.size()),
      counted_(counts_.size() / 64 + 1) {}

void ObjectFeatures::extract(Screen screen, ActiveFeatures& active) {
  active.clear();
  const std::vector<Instance>& instances = finder_.find(screen);
  std::array<bool, kMostClasses> present{};
  for (const Instance& instance : instances) present[instance.class_number] = true;
  for (std::uint32_t number = 0; number < classes_; ++number)
    if (!present[number]) add(number);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Instance& one = instances[i];
    for (std::uint32_t tiling = 0; tiling < places_.tilings(); ++tiling)
      add(first_place_ + one.class_number * places_.size() + places_.tile(tiling, one.box.x(), one.box.y()));
    for (std::size_t j = 0; j < i; ++j) add_pair(one, instances[j]);
  }
  take_counts(active);
}

void ObjectFeatures::add(std::uint32_t feature) {
  ++counts_[feature];
  counted_[feature / 64] |= std::uint64_t{1} << (feature % 64);
}

// Moves what was counted to `active`.
void ObjectFeatures::take_counts(ActiveFeatures& active) {
  for (std::size_t word = 0; word < counted_.size(); ++word) {
    for (std::uint64_t left = std::exchange(counted_[word], 0); left != 0; left &= left - 1) {
      const auto feature =
          static_cast<std::uint32_t>(word * 64) + static_cast<std::uint32_t>(std::countr_zero(left));
      active.indices.push_back(feature);
      active.counts.push_back(std::exchange(counts_[feature], 0.0F));
    }
  }
}

// From the lower class to the higher; none for two of the same class.
void ObjectFeatures::add_pair(const Instance& one, const Instance& other) {
  if (one.class_number == other.class_number) return;
  const auto& [from, to] =
      one.class_number < other.class_number ? std::tie(one, other) : std::tie(other, one);
  const int x = to.box.x() - from.box.x(), y = to.box.y() - from.box.y();
  const auto approaches = static_cast<std::uint32_t>(approach(x, to.velocity.x - from.velocity.x)) +
                          2 * static_cast<std::uint32_t>(approach(y, to.velocity.y - from.velocity.y));
  const std::uint32_t pair = pair_index(from.class_number, to.class_number);
  const std::uint32_t first = first_pair_ + (pair * kApproaches + approaches) * distances_.size();
  for (std::uint32_t tiling = 0; tiling < distances_.tilings(); ++tiling)
    add(first + distances_.tile(tiling, x + kFeatureWidth - 1, y + kFeatureHeight - 1));
}

}  // namespace racebeam

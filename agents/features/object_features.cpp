#include "agents/features/object_features.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace racebeam {
namespace {

constexpr int kMaxInstances = 50;  // of a class; paper-notes

}  // namespace

InstanceFinder::InstanceFinder(const Background& background, const ObjectClasses& classes, int reach)
    : reach_(reach), objects_(background, reach) {
  for (std::uint32_t number = 0; number < classes.size(); ++number)
    for (const Shape& shape : classes[number])
      for (int mirror = 0; mirror < kMirrors; ++mirror)
        class_of_.emplace(key_of(mirrored(shape, mirror)), number);
}

void InstanceFinder::forget() {
  objects_.forget();
  instances_.clear();
}

const std::vector<Instance>& InstanceFinder::find(Screen screen) {
  std::swap(instances_, before_);
  instances_.clear();
  objects_.see(screen);
  for (const ScreenObject& object : objects_.objects().all()) {
    if (add(object)) continue;
    for (std::uint32_t part = 0; part < object.part_count; ++part)
      add(objects_.part(object.first_part + part));
  }
  std::ranges::stable_sort(instances_, std::ranges::greater{}, &Instance::area);
  std::array<int, kMaxClasses> count{};
  std::erase_if(instances_,
                [&](const Instance& instance) { return ++count[instance.class_number] > kMaxInstances; });
  return instances_;
}

// Returns whether the object's shape is of a class.
bool InstanceFinder::add(const ScreenObject& object) {
  const auto found = class_of_.find(object.key);
  if (found == class_of_.end()) return false;
  instances_.push_back({found->second, object.area, object.box,
                        object.velocity ? *object.velocity : velocity_by_class(found->second, object.box)});
  return true;
}

// The way of an animated object, which looks different on the screen before: from the nearest object of its
// class. Without such an object, it is at rest.
Velocity InstanceFinder::velocity_by_class(std::uint32_t class_number, const Box& box) const {
  Velocity velocity{0, 0};
  int least = std::numeric_limits<int>::max();
  for (const Instance& other : before_) {
    const Velocity found = displacement(other.box, box);
    const int square = found.x * found.x + found.y * found.y;
    if (other.class_number != class_number || !is_within_reach(found, reach_) || square >= least) continue;
    least = square;
    velocity = found;
  }
  return velocity;
}

ObjectFeatures::ObjectFeatures(const Background& background, const ObjectClasses& classes,
                               const ObjectSettings& settings)
    : finder_(background, classes, settings.reach),
      count_instances_(settings.count_instances),
      places_(kFeatureWidth, kFeatureHeight, settings.tilings, settings.grid),
      distances_(2 * kFeatureWidth - 1, 2 * kFeatureHeight - 1, settings.tilings, settings.grid),
      velocities_(4 * settings.reach + 1, 4 * settings.reach + 1, settings.tilings, settings.grid),
      fastest_(2 * settings.reach),
      classes_(static_cast<std::uint32_t>(classes.size())),
      first_place_(classes_),
      first_pair_(first_place_ + classes_ * places_.size()),
      size_(first_pair_ + pairs_of(classes_) * velocities_.tiles() * distances_.size()) {}

void ObjectFeatures::extract(Screen screen, ActiveFeatures& active) {
  active.clear();
  if (counts_.empty()) make_room();
  const std::vector<Instance>& instances = finder_.find(screen);
  std::array<bool, kMaxClasses> present{};
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

// Late, so that a learner refuses too many features before memory is taken.
void ObjectFeatures::make_room() {
  counts_.resize(size_);
  counted_.resize(size_ / 64 + 1);
}

void ObjectFeatures::add(std::uint32_t feature) {
  ++counts_[feature];
  counted_[feature / 64] |= std::uint64_t{1} << (feature % 64);
}

// Moves what was counted to `active`.
void ObjectFeatures::take_counts(ActiveFeatures& active) {
  for (std::size_t word = 0; word < counted_.size(); ++word) {
    for (std::uint64_t bits = std::exchange(counted_[word], 0); bits != 0; bits &= bits - 1) {
      const auto feature =
          static_cast<std::uint32_t>(word * 64) + static_cast<std::uint32_t>(std::countr_zero(bits));
      active.indices.push_back(feature);
      const float count = std::exchange(counts_[feature], 0.0F);
      if (count_instances_) active.counts.push_back(count);
    }
  }
}

// From the lower class to the higher; none for two of the same class.
void ObjectFeatures::add_pair(const Instance& one, const Instance& other) {
  if (one.class_number == other.class_number) return;
  const auto& [from, to] =
      one.class_number < other.class_number ? std::tie(one, other) : std::tie(other, one);
  const Velocity distance = displacement(from.box, to.box);
  const Velocity velocity{to.velocity.x - from.velocity.x, to.velocity.y - from.velocity.y};
  const std::uint32_t first =
      first_pair_ + pair_index(from.class_number, to.class_number) * velocities_.tiles() * distances_.size();
  for (std::uint32_t tiling = 0; tiling < distances_.tilings(); ++tiling) {
    const std::uint32_t motion =
        velocities_.tile(tiling, velocity.x + fastest_, velocity.y + fastest_) - tiling * velocities_.tiles();
    add(first + motion * distances_.size() +
        distances_.tile(tiling, distance.x + kFeatureWidth - 1, distance.y + kFeatureHeight - 1));
  }
}

}  // namespace racebeam

#include "agents/features/moving_objects.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <tuple>

namespace racebeam {
namespace {

constexpr int kAreaPercent = 120, kDifferentPercent = 10;

bool of_similar_area(const ScreenObject& a, const ScreenObject& b) {
  return std::max(a.area, b.area) * 100 <= std::min(a.area, b.area) * kAreaPercent;
}

Box around(const Box& a, const Box& b) {
  const int left = std::min(a.left, b.left), top = std::min(a.top, b.top);
  return {left, top, std::max(a.left + a.width, b.left + b.width) - left,
          std::max(a.top + a.height, b.top + b.height) - top};
}

// Makes a shape of the runs of several that do not overlap.
void put_in_order(Shape& runs) {
  std::ranges::sort(runs, {}, [](const PixelRun& run) { return std::tuple(run.row, run.first); });
  std::size_t last = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i].row == runs[last].row && runs[i].first == runs[last].last + 1)
      runs[last].last = runs[i].last;
    else
      runs[++last] = runs[i];
  }
  runs.resize(last + 1);
}

}  // namespace

Velocity displacement(const Box& from, const Box& to) { return {to.x() - from.x(), to.y() - from.y()}; }

bool is_within_reach(const Velocity& distance, int reach) {
  return std::abs(distance.x) <= reach && std::abs(distance.y) <= reach;
}

void ObjectList::clear() {
  objects_.clear();
  runs_.clear();
}

ScreenObject& ObjectList::add(const Box& box, int area, ShapeView shape) {
  const auto first = static_cast<std::uint32_t>(runs_.size());
  runs_.insert(runs_.end(), shape.begin(), shape.end());
  objects_.push_back({.box = box,
                      .area = area,
                      .key = key_of(shape),
                      .velocity = {},
                      .first_run = first,
                      .run_count = static_cast<std::uint32_t>(shape.size()),
                      .first_part = 0,
                      .part_count = 0});
  return objects_.back();
}

const ScreenObject* ObjectList::nearest(const ScreenObject& object, ShapeView shape_of_it, int reach) const {
  const ScreenObject* best = nullptr;
  std::tuple<bool, int> least;  // whether the shapes differ, and the square of the distance
  for (const ScreenObject& other : objects_) {
    const Velocity velocity = displacement(other.box, object.box);
    if (!is_within_reach(velocity, reach) || !of_similar_area(object, other)) continue;
    const std::tuple found(other.key != object.key, velocity.x * velocity.x + velocity.y * velocity.y);
    if (best && found >= least) continue;
    if (other.key != object.key &&
        difference(shape_of_it, shape(other)) * 100 > std::max(object.area, other.area) * kDifferentPercent)
      continue;
    best = &other;
    least = found;
  }
  return best;
}

void MovingObjects::forget() {
  now_.regions.clear();
  now_.objects.clear();
}

void MovingObjects::see(Screen screen) {
  std::swap(now_, before_);
  now_.regions.clear();
  now_.objects.clear();
  regions_.find(screen);
  for (const Region& region : regions_.all()) {
    const ShapeView shape = regions_.shape(region);
    ScreenObject& object = now_.regions.add(region.box, region.area, shape);
    if (const ScreenObject* const earlier = before_.regions.nearest(object, shape, reach_))
      object.velocity = displacement(earlier->box, object.box);
  }
  join_neighbours();
}

void MovingObjects::join_neighbours() {
  const std::vector<ScreenObject>& regions = now_.regions.all();
  parent_.resize(regions.size());
  std::iota(parent_.begin(), parent_.end(), 0);
  for (const auto& [one, other] : regions_.touching()) {
    if (!regions[one].velocity || regions[one].velocity != regions[other].velocity) continue;
    const std::uint32_t a = root(one), b = root(other);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  parts_.resize(regions.size());
  std::iota(parts_.begin(), parts_.end(), 0);
  std::ranges::stable_sort(parts_, {}, [this](std::uint32_t region) { return root(region); });
  for (std::size_t first = 0; first < parts_.size();) {
    std::size_t end = first + 1;
    while (end < parts_.size() && root(parts_[end]) == parts_[first]) ++end;
    add_object(first, end - first);
    first = end;
  }
}

std::uint32_t MovingObjects::root(std::uint32_t region) {
  while (parent_[region] != region) region = parent_[region] = parent_[parent_[region]];
  return region;
}

// Adds the object that consists of the regions parts_[first] and so on.
void MovingObjects::add_object(std::size_t first, std::size_t count) {
  const ScreenObject& top = part(static_cast<std::uint32_t>(first));
  Box box = top.box;
  int area = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    box = around(box, now_.regions.all()[parts_[i]].box);
    area += now_.regions.all()[parts_[i]].area;
  }
  joined_.clear();
  for (std::size_t i = first; i < first + count; ++i) {
    const ScreenObject& region = now_.regions.all()[parts_[i]];
    const int right = region.box.left - box.left, down = region.box.top - box.top;
    for (const PixelRun& run : now_.regions.shape(region))
      joined_.push_back({static_cast<std::uint8_t>(run.row + down),
                         static_cast<std::uint8_t>(run.first + right),
                         static_cast<std::uint8_t>(run.last + right)});
  }
  if (count > 1) put_in_order(joined_);
  ScreenObject& object = now_.objects.add(box, area, joined_);
  object.velocity = top.velocity;
  if (count == 1) return;
  object.first_part = static_cast<std::uint32_t>(first);
  object.part_count = static_cast<std::uint32_t>(count);
}

}  // namespace racebeam

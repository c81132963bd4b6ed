// The objects of a screen, and how they have moved since the screen before: regions, of which neighbours with
// the same velocity are joined (docs/paper-notes.md, "Objects").
#pragma once

#include <algorithm>
#include <optional>

#include "agents/features/regions.hpp"

namespace racebeam {

// How far an object goes in a decision of `frame_skip` frames, in x and in y: 8 pixels a frame (appendix C,
// "Maximum object velocity (pixels)").
constexpr int reach_of(int frame_skip) { return std::min(8 * frame_skip, kFeatureHeight); }

struct Velocity {
  int x, y;  // pixels a decision
  bool operator==(const Velocity&) const = default;
};

// Returns the displacement from the centre of one box to that of another.
Velocity displacement(const Box& from, const Box& to);

// Whether the distance is at most `reach` pixels in x and in y.
bool is_within_reach(const Velocity& distance, int reach);

struct ScreenObject {
  Box box;
  int area;
  ShapeKey key;
  std::optional<Velocity> velocity;  // nothing: the object was not on the screen before
  std::uint32_t first_run, run_count;
  std::uint32_t first_part, part_count;  // the regions that were joined; none: it is a region itself
};

// Objects with the runs of their shapes.
class ObjectList {
 public:
  void clear();
  // Appends an object of this shape.
  ScreenObject& add(const Box& box, int area, ShapeView shape);

  const std::vector<ScreenObject>& all() const { return objects_; }
  ScreenObject& operator[](std::size_t place) { return objects_[place]; }
  ShapeView shape(const ScreenObject& object) const {
    return ShapeView(runs_).subspan(object.first_run, object.run_count);
  }

  // Returns the nearest object of this list that `object`, of this shape, can have been on the screen before.
  // It is within reach and has the same shape. If none has, its area is within a factor of 1.2, and at most
  // 10 % of its pixels differ. Returns null if none fits.
  const ScreenObject* nearest(const ScreenObject& object, ShapeView shape, int reach) const;

 private:
  std::vector<ScreenObject> objects_;
  std::vector<PixelRun> runs_;
};

class MovingObjects {
 public:
  // No object goes further than `reach` pixels, in x or in y, from one screen to the next.
  MovingObjects(const Background& background, int reach) : regions_(background), reach_(reach) {}

  void forget();  // the screen before
  void see(Screen screen);

  const ObjectList& objects() const { return now_.objects; }  // regions that are not joined, and joined ones
  const ScreenObject& part(std::uint32_t place) const { return now_.regions.all()[parts_[place]]; }

  // The object of the screen before that `object` was; null: it was not there.
  const ScreenObject* earlier(const ScreenObject& object) const {
    return before_.objects.nearest(object, now_.objects.shape(object), reach_);
  }

 private:
  struct Seen {
    ObjectList regions, objects;
  };
  void join_neighbours();
  void add_object(std::size_t first, std::size_t count);
  std::uint32_t root(std::uint32_t region);

  Regions regions_;
  const int reach_;
  Seen now_, before_;
  std::vector<std::uint32_t> parent_;  // per region: an earlier one of its object, or itself
  std::vector<std::uint32_t> parts_;   // regions in the order of objects
  Shape joined_;
};

}  // namespace racebeam

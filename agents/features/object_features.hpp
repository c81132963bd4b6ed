// DISCO: the places of objects of discovered classes, and where the objects of two classes are and move as
// seen from each other (appendix A.3 of the paper; docs/paper-notes.md, "Objects").
#pragma once

#include "agents/features/feature_set.hpp"
#include "agents/features/object_classes.hpp"
#include "agents/features/tile_coding.hpp"

namespace racebeam {

// An object of a class.
struct Instance {
  std::uint32_t class_number;
  int area;
  Box box;
  Velocity velocity;
};

// Finds the instances of classes on one screen after the other.
class InstanceFinder {
 public:
  // `reach`: of objects from screen to screen, in pixels.
  InstanceFinder(const Background& background, const ObjectClasses& classes, int reach);

  void forget();  // the screen before

  // The largest first; at most 50 of a class.
  const std::vector<Instance>& find(Screen screen);

 private:
  bool add(const ScreenObject& object);
  Velocity velocity_by_class(std::uint32_t class_number, const Box& box) const;

  const int reach_;
  MovingObjects objects_;
  std::unordered_map<ShapeKey, std::uint32_t> class_of_;  // of shapes and their mirror images
  std::vector<Instance> instances_, before_;
};

// Defaults: the paper, appendix C, where not said otherwise.
struct ObjectSettings {
  int tilings = 8, grid = 8;
  int reach = reach_of(5);      // of objects from decision to decision, in pixels
  bool count_instances = true;  // paper-notes: a feature of several instances is there so often, or once
};

class ObjectFeatures final : public FeatureSet {
 public:
  ObjectFeatures(const Background& background, const ObjectClasses& classes, const ObjectSettings& settings);

  std::size_t size() const override { return size_; }
  void begin_episode() override { finder_.forget(); }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }

  // The features say of each class that it is absent, or the tiles of its instances. For each pair of
  // classes, they say in tiles where the second one's instances are and how they move, as seen from the
  // first.
  void extract(Screen screen, ActiveFeatures& active);

 private:
  void make_room();
  void add(std::uint32_t feature);
  void add_pair(const Instance& one, const Instance& other);
  void take_counts(ActiveFeatures& active);

  InstanceFinder finder_;
  const bool count_instances_;
  const TileCoding places_, distances_, velocities_;
  const int fastest_;  // of relative velocities, in x and in y
  std::uint32_t classes_, first_place_, first_pair_;
  std::size_t size_;
  std::vector<float> counts_;           // per feature; 0 between calls
  std::vector<std::uint64_t> counted_;  // a bit for each feature with a count
  FeatureScreen screen_;
};

}  // namespace racebeam

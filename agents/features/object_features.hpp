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
  InstanceFinder(const Background& background, const ObjectClasses& classes);

  void forget() { objects_.forget(); }  // the screen before

  // The largest first; at most 50 of a class.
  const std::vector<Instance>& find(Screen screen);

 private:
  bool add(const ScreenObject& object);

  MovingObjects objects_;
  std::unordered_map<ShapeKey, std::uint32_t> class_of_;  // of shapes and their mirror images
  std::vector<Instance> instances_;
};

class ObjectFeatures final : public FeatureSet {
 public:
  ObjectFeatures(const Background& background, const ObjectClasses& classes, int tilings, int grid);

  std::size_t size() const override { return counts_.size(); }
  void begin_episode() override { finder_.forget(); }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }

  // Of C classes: that a class is absent; the tiles of its instances; for each pair of classes, whether two
  // instances approach each other in x (1) and in y (2), and the tiles of the second as seen from the first.
  // Features that several instances have are counted.
  void extract(Screen screen, ActiveFeatures& active);

 private:
  void add(std::uint32_t feature);
  void add_pair(const Instance& one, const Instance& other);
  void take_counts(ActiveFeatures& active);

  InstanceFinder finder_;
  TileCoding places_, distances_;
  std::uint32_t classes_, first_place_, first_pair_;
  std::vector<float> counts_;           // of each feature; 0 between calls
  std::vector<std::uint64_t> counted_;  // a bit for each feature with a count
  FeatureScreen screen_;
};

}  // namespace racebeam

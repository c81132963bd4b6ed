// The classes of objects in a game, as DISCO discovers them from sample screens (appendix A.3 of the paper;
// docs/paper-notes.md, "Objects").
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "agents/features/moving_objects.hpp"

namespace racebeam {

constexpr int kMaxClasses = 10;  // appendix C, "Maximum number of classes"

// Its shapes, the most frequent first. Their mirror images are of the class, too.
using ObjectClass = std::vector<Shape>;
using ObjectClasses = std::vector<ObjectClass>;

class ClassDiscovery {
 public:
  // `reach`: of objects from screen to screen, in pixels.
  ClassDiscovery(const Background& background, int reach) : objects_(background, reach) {}

  // `first`: of a trajectory, so that nothing has moved on the way to it.
  void add(Screen screen, bool first);

  // Merges classes of similar shapes, leaves out those that are rare or restricted to a small region, and
  // merges the others until there are few enough. They are in the order in which they were first seen.
  ObjectClasses classes() const;

 private:
  using ShapeNumbers = std::vector<std::uint32_t>;  // the shapes of a class, in shapes_
  struct SeenShape {
    Shape shape;
    std::uint32_t class_number, count;
  };
  struct SeenClass {
    int last_screen = -1;
    int screens = 0;                                                        // on which it was
    int left = kFeatureWidth, right = 0, top = kFeatureHeight, bottom = 0;  // of the centres of its objects
  };
  struct Candidate {
    ShapeNumbers shapes;  // the most frequent first
    SeenClass seen;
  };
  using Candidates = std::vector<Candidate>;

  std::uint32_t shape_number(const ScreenObject& object);
  std::uint32_t class_of_new(const ScreenObject& object);
  void count(const ScreenObject& object, SeenClass& seen) const;
  bool is_frequent(const SeenClass& seen, int percent) const;
  bool is_kept(const SeenClass& seen) const;
  Candidates candidates() const;
  std::vector<std::size_t> frequent(const Candidates& classes) const;
  void merge_similar(Candidates& classes) const;
  void merge_nearest(Candidates& classes) const;
  double difference_of(const Candidate& a, const Candidate& b) const;
  void absorb(Candidate& into, Candidate& from) const;
  void most_frequent_first(ShapeNumbers& shapes) const;

  MovingObjects objects_;
  int screens_ = 0;
  std::vector<SeenShape> shapes_;
  std::vector<SeenClass> classes_;
  std::unordered_map<ShapeKey, std::uint32_t> number_of_;  // of shapes and their mirror images, in shapes_
};

ObjectClasses discover_classes(const Cartridge& cartridge, const SampleSettings& settings,
                               const Background& background);

// A line for each shape: its class, and its runs as ROW,FIRST,LAST. Throws InvalidInput, naming `name`, for
// other text, and for more than 10 classes.
std::string text_of(const ObjectClasses& classes);
ObjectClasses classes_of_text(const std::string& name, std::string_view text);

}  // namespace racebeam

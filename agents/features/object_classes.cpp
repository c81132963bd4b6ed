#include "agents/features/object_classes.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>

#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr int kMinScreensPercent = 20;      // appendix C, "Minimum frequency of class appearance"
constexpr int kMinRange = 16;               // of their centres, in pixels, in x or in y; paper-notes
constexpr int kMinArea = 5;                 // of an object of a class, in pixels; paper-notes
constexpr double kMaxDifference = 0.45;     // of the shapes of similar classes; paper-notes
constexpr int kMinComparedPercent = 2;      // of the screens, on which a similar class is
constexpr std::size_t kMaxCompared = 200;   // classes, which takes 20,000 comparisons
constexpr std::size_t kMaxShapes = 200000;  // later ones are noise
constexpr PixelRun kNoRun{255, 255, 255};
constexpr std::uint32_t kNoShape = std::numeric_limits<std::uint32_t>::max();

// "ROW,FIRST,LAST"
std::optional<PixelRun> run_of(std::string_view text) {
  std::array<std::uint8_t, 3> numbers{};
  for (std::uint8_t& number : numbers) {
    const std::string_view word = text.substr(0, text.find(','));
    const auto value = parse_number<std::uint8_t>(word);
    if (!value) return std::nullopt;
    number = *value;
    const bool last = &number == &numbers.back();
    if (last != (word.size() == text.size())) return std::nullopt;
    text.remove_prefix(std::min(word.size() + 1, text.size()));
  }
  return PixelRun{numbers[0], numbers[1], numbers[2]};
}

bool is_shape(ShapeView runs) {
  if (runs.empty()) return false;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].row >= kFeatureHeight || runs[i].last >= kFeatureWidth || runs[i].first > runs[i].last)
      return false;
    if (i > 0 && (runs[i].row < runs[i - 1].row ||
                  (runs[i].row == runs[i - 1].row && runs[i].first <= runs[i - 1].last + 1)))
      return false;
  }
  const Box box = box_of(runs);
  return box.left == 0 && box.top == 0;
}

// From 0, the same pixels, to 1: of the larger shape, the best of the mirror images.
double distance(ShapeView a, ShapeView b) {
  int least = std::numeric_limits<int>::max();
  for (int mirror = 0; mirror < kMirrors; ++mirror)
    least = std::min(least, difference(a, mirrored(b, mirror)));
  return static_cast<double>(least) / std::max(area_of(a), area_of(b));
}

}  // namespace

void ClassDiscovery::add(Screen screen, bool first) {
  if (first) objects_.forget();
  objects_.see(screen);
  for (const ScreenObject& object : objects_.objects().all()) {
    const std::uint32_t number = object.area < kMinArea ? kNoShape : shape_number(object);
    if (number == kNoShape) continue;
    ++shapes_[number].count;
    count(object, classes_[shapes_[number].class_number]);
  }
  ++screens_;
}

// The number of the object's shape, which is made if it is new.
std::uint32_t ClassDiscovery::shape_number(const ScreenObject& object) {
  if (const auto found = number_of_.find(object.key); found != number_of_.end()) return found->second;
  if (shapes_.size() == kMaxShapes) return kNoShape;
  const ShapeView shape = objects_.objects().shape(object);
  const std::uint32_t class_number = class_of_new(object);
  const auto number = static_cast<std::uint32_t>(shapes_.size());
  for (int mirror = 0; mirror < kMirrors; ++mirror)
    number_of_.emplace(key_of(mirrored(shape, mirror)), number);
  shapes_.push_back({Shape(shape.begin(), shape.end()), class_number, 0});
  return number;
}

// The class of an object whose shape is new: that of the object that it was, or its own class.
std::uint32_t ClassDiscovery::class_of_new(const ScreenObject& object) {
  if (const ScreenObject* const earlier = objects_.earlier(object))
    if (const auto found = number_of_.find(earlier->key); found != number_of_.end())
      return shapes_[found->second].class_number;
  classes_.emplace_back();
  return static_cast<std::uint32_t>(classes_.size() - 1);
}

void ClassDiscovery::count(const ScreenObject& object, SeenClass& seen) const {
  seen.screens += seen.last_screen != screens_;
  seen.last_screen = screens_;
  seen.left = std::min(seen.left, object.box.x());
  seen.right = std::max(seen.right, object.box.x());
  seen.top = std::min(seen.top, object.box.y());
  seen.bottom = std::max(seen.bottom, object.box.y());
}

bool ClassDiscovery::is_frequent(const SeenClass& seen, int percent) const {
  return std::int64_t{seen.screens} * 100 >= std::int64_t{screens_} * percent;
}

bool ClassDiscovery::is_kept(const SeenClass& seen) const {
  return is_frequent(seen, kMinScreensPercent) &&
         std::max(seen.right - seen.left, seen.bottom - seen.top) >= kMinRange;
}

ObjectClasses ClassDiscovery::classes() const {
  Candidates found = candidates();
  merge_similar(found);
  std::erase_if(found, [this](const Candidate& each) { return !is_kept(each.seen); });
  while (found.size() > kMaxClasses) merge_nearest(found);
  ObjectClasses classes;
  for (const Candidate& each : found) {
    classes.emplace_back();
    for (const std::uint32_t number : each.shapes) classes.back().push_back(shapes_[number].shape);
  }
  return classes;
}

// All classes, in the order in which they were first seen.
ClassDiscovery::Candidates ClassDiscovery::candidates() const {
  Candidates all;
  for (const SeenClass& seen : classes_) all.push_back({{}, seen});
  for (std::uint32_t number = 0; number < shapes_.size(); ++number)
    all[shapes_[number].class_number].shapes.push_back(number);
  for (Candidate& each : all) most_frequent_first(each.shapes);
  return all;
}

// The places of the most frequent classes, which ascend.
std::vector<std::size_t> ClassDiscovery::frequent(const Candidates& classes) const {
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < classes.size(); ++place)
    if (is_frequent(classes[place].seen, kMinComparedPercent)) places.push_back(place);
  std::ranges::stable_sort(places, std::ranges::greater{},
                           [&](std::size_t place) { return classes[place].seen.screens; });
  places.resize(std::min(places.size(), kMaxCompared));
  std::ranges::sort(places);
  return places;
}

// Merges each frequent class into the first that is similar to it, or to one that is merged into that. What
// is left of a merged class was never seen.
void ClassDiscovery::merge_similar(Candidates& classes) const {
  const std::vector<std::size_t> places = frequent(classes);
  std::vector<std::size_t> into = places;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (into[i] == into[j]) continue;
      if (difference_of(classes[places[i]], classes[places[j]]) > kMaxDifference) continue;
      const std::size_t first = std::min(into[i], into[j]), second = std::max(into[i], into[j]);
      std::ranges::replace(into, second, first);
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    if (into[i] != places[i]) absorb(classes[into[i]], classes[places[i]]);
}

// Merges the two classes whose most frequent shapes differ least.
void ClassDiscovery::merge_nearest(Candidates& classes) const {
  double least = std::numeric_limits<double>::infinity();
  std::size_t into = 0, from = 0;
  for (std::size_t a = 0; a < classes.size(); ++a) {
    for (std::size_t b = a + 1; b < classes.size(); ++b) {
      const double found = difference_of(classes[a], classes[b]);
      if (found >= least) continue;
      least = found;
      into = a;
      from = b;
    }
  }
  absorb(classes[into], classes[from]);
  classes.erase(classes.begin() + static_cast<std::ptrdiff_t>(from));
}

// Their most frequent shapes are compared.
double ClassDiscovery::difference_of(const Candidate& a, const Candidate& b) const {
  return distance(shapes_[a.shapes.front()].shape, shapes_[b.shapes.front()].shape);
}

// A screen that has both counts twice.
void ClassDiscovery::absorb(Candidate& into, Candidate& from) const {
  into.shapes.insert(into.shapes.end(), from.shapes.begin(), from.shapes.end());
  most_frequent_first(into.shapes);
  into.seen.screens += from.seen.screens;
  into.seen.left = std::min(into.seen.left, from.seen.left);
  into.seen.right = std::max(into.seen.right, from.seen.right);
  into.seen.top = std::min(into.seen.top, from.seen.top);
  into.seen.bottom = std::max(into.seen.bottom, from.seen.bottom);
  from = {};
}

void ClassDiscovery::most_frequent_first(ShapeNumbers& shapes) const {
  std::ranges::stable_sort(shapes, std::ranges::greater{},
                           [this](std::uint32_t number) { return shapes_[number].count; });
}

ObjectClasses discover_classes(const Cartridge& cartridge, const SampleSettings& settings,
                               const Background& background) {
  ClassDiscovery discovery(background, reach_of(settings.play.machine.frame_skip));
  FeatureScreen screen;
  sample_screens(cartridge, settings, settings.class_screens, settings.seed,
                 [&](const Environment& machine, bool first) { discovery.add(screen.of(machine), first); });
  return discovery.classes();
}

std::string text_of(const ObjectClasses& classes) {
  std::string text;
  for (std::size_t number = 0; number < classes.size(); ++number) {
    for (const Shape& shape : classes[number]) {
      text += std::to_string(number);
      for (const PixelRun& run : shape) {
        (text += ' ') += std::to_string(run.row);
        (text += ',') += std::to_string(run.first);
        (text += ',') += std::to_string(run.last);
      }
      text += '\n';
    }
  }
  return text;
}

ObjectClasses classes_of_text(const std::string& name, std::string_view text) {
  ObjectClasses classes;
  std::vector<std::string_view> words;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(row.size() + 1, text.size()));
    words.clear();
    split(row, words);
    const auto number = words.empty() ? std::nullopt : parse_number<std::size_t>(words[0]);
    if (number && *number == classes.size() && *number < kMaxClasses) classes.emplace_back();
    Shape shape;
    for (std::size_t i = 1; i < words.size(); ++i) shape.push_back(run_of(words[i]).value_or(kNoRun));
    if (!number || *number + 1 != classes.size() || !is_shape(shape))
      throw InvalidInput(
          name + ":" + std::to_string(line) +
          ": it is not the shape of a class; accepted: the number of the class, from 0 to 9 in "
          "their order, and runs of pixels, ROW,FIRST,LAST");
    classes.back().push_back(std::move(shape));
  }
  return classes;
}

}  // namespace racebeam

#include "agents/features/object_classes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "agents/features/game_facts.hpp"
#include "system/invalid_input.hpp"
#include "tests/agents/experiment/samples.hpp"
#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

const Pattern kFish = {" ###  #", "#######", " ###  #"};
const Pattern kFishTurned = {"#  ### ", "#######", "#  ### "};
const Pattern kDiver = {" # ", "###", " # ", "# #", "# #"};
const Pattern kRare = {"#####", "#   #", "#####"};
const Pattern kBow = {"#   #", " # # ", "  #  ", "  #  "};
const Pattern kStill = {"####", "####"};

// A place on a way of `range` pixels, to and fro.
int to_and_fro(int step, int range) {
  const int at = step % (2 * range);
  return at < range ? at : 2 * range - at;
}

bool goes_right(int step, int range) { return step % (2 * range) < range; }

}  // namespace

TEST_CASE("A drawn world has the right classes: mirrored, not rare, not still") {
  ClassDiscovery discovery({}, 8);
  for (int step = 0; step < 1000; ++step) {
    DrawnScreen screen;
    screen.draw(20 + to_and_fro(step, 100), 50, goes_right(step, 100) ? kFishTurned : kFish);
    screen.draw(70, 100 + to_and_fro(2 * step, 80), kDiver);
    screen.draw(140, 20, kStill);
    if (step % 6 == 0) screen.draw(20 + step % 100, 190, kRare);  // on 17 % of the screens
    discovery.add(screen.pixels, step == 0);
  }
  CHECK(discovery.classes() == ObjectClasses{{shape_of(kFishTurned)}, {shape_of(kDiver)}});
}

// Heroes and invaders: where they stand, they look as on the screen before; where they go, they do not.
TEST_CASE("What is fast, or looks different at each step, is a class") {
  ClassDiscovery discovery({}, 40);
  for (int step = 0; step < 1000; ++step) {
    DrawnScreen screen;
    const int steps = step - step % 10 / 9;  // each tenth screen shows the one before
    screen.draw(20 + to_and_fro(12 * steps, 96), 50, steps % 2 == 0 ? kFish : kDiver);
    screen.draw(20 + to_and_fro(steps, 100), 100, steps % 2 == 0 ? kRare : kBow);
    screen.draw(140, 20, kStill);
    discovery.add(screen.pixels, step == 0);
  }
  ObjectClasses classes = discovery.classes();
  const ObjectClasses expected{{shape_of(kFish)}, {shape_of(kRare)}, {shape_of(kDiver)}, {shape_of(kBow)}};
  CHECK(classes == expected);
}

TEST_CASE("A class is on at least a fifth of the screens") {
  ClassDiscovery enough({}, 8), too_few({}, 8);
  for (int step = 0; step < 1000; ++step) {
    const DrawnScreen screen = DrawnScreen().draw(20 + step % 50, 50, kFish), empty;
    enough.add((step < 200 ? screen : empty).pixels, true);
    too_few.add((step < 199 ? screen : empty).pixels, true);
  }
  CHECK(enough.classes().size() == 1);
  CHECK(too_few.classes().empty());
}

TEST_CASE("Objects that move within a small region do not make a class") {
  ClassDiscovery near({}, 8), far({}, 8), flat({}, 8), high({}, 8);
  for (int step = 0; step < 100; ++step) {
    near.add(DrawnScreen().draw(20 + to_and_fro(step, 15), 50, kFish).pixels, step == 0);
    far.add(DrawnScreen().draw(20 + to_and_fro(step, 16), 50, kFish).pixels, step == 0);
    flat.add(DrawnScreen().draw(20, 50 + to_and_fro(step, 15), kFish).pixels, step == 0);
    high.add(DrawnScreen().draw(20, 50 + to_and_fro(step, 16), kFish).pixels, step == 0);
  }
  CHECK(near.classes().empty());
  CHECK(far.classes().size() == 1);
  CHECK(flat.classes().empty());
  CHECK(high.classes().size() == 1);
}

// It grows from 10 to 20 pixels. Of the lengths between, each is too rare to be compared.
TEST_CASE("A shape that another one turned into is of its class") {
  ClassDiscovery discovery({}, 8), leaps({}, 8);
  for (int step = 0; step < 1000; ++step) {
    const std::string bar(static_cast<std::size_t>(10 + std::clamp(step % 100 - 44, 0, 10)), '#');
    const DrawnScreen screen = DrawnScreen().draw(20 + to_and_fro(step, 100), 50, {bar, bar});
    discovery.add(screen.pixels, step == 0);
    leaps.add(screen.pixels, true);  // nothing is before
  }
  REQUIRE(discovery.classes().size() == 1);
  CHECK(discovery.classes()[0].size() == 11);
  CHECK(leaps.classes().size() == 2);
  for (const ObjectClass& one : leaps.classes()) CHECK(one.size() == 1);
}

TEST_CASE("Frequent shapes of which at most 45 % of the pixels are different are one class") {
  const auto classes_of_bars = [](std::size_t length, std::size_t other, int often) {
    ClassDiscovery discovery({}, 8);
    for (int step = 0; step < 1000; ++step) {
      const std::string bar(step % often == 0 ? other : length, '#');
      discovery.add(DrawnScreen().draw(20 + step % 50, 50, {bar, bar}).pixels, true);
    }
    return discovery.classes();
  };
  CHECK(classes_of_bars(20, 11, 2).size() == 1);
  CHECK(classes_of_bars(20, 10, 2).size() == 2);
  CHECK(classes_of_bars(20, 11, 50)[0].size() == 2);
  CHECK(classes_of_bars(20, 11, 51)[0].size() == 2);
  CHECK(classes_of_bars(20, 11, 53)[0].size() == 1);  // on less than 2 % of the screens
}

TEST_CASE("A class of two similar shapes may be frequent where neither is, and move where neither does") {
  const Pattern open = {"######", "####  ", "######"}, shut = {"######", "##### ", "######"};
  const auto [right, down] =
      GENERATE(std::pair(16, 0), std::pair(-16, 0), std::pair(0, 16), std::pair(0, -16));
  ClassDiscovery together({}, 8), one({}, 8);
  for (int step = 0; step < 100; ++step) {
    DrawnScreen screen;
    if (step % 8 == 0) screen.draw(50, 50, open);
    if (step % 8 == 4) screen.draw(50 + right, 50 + down, shut);
    together.add(screen.pixels, true);
    one.add(step % 8 == 4 ? DrawnScreen().pixels : screen.pixels, true);
  }
  CHECK(together.classes() == ObjectClasses{{shape_of(open), shape_of(shut)}});
  CHECK(one.classes().empty());
}

TEST_CASE("Objects of fewer than five pixels have no class") {
  ClassDiscovery discovery({}, 8);
  for (int step = 0; step < 100; ++step)
    discovery.add(DrawnScreen().draw(step, 50, {"####"}).draw(step, 90, {"#####"}).pixels, step == 0);
  CHECK(discovery.classes() == ObjectClasses{{shape_of({"#####"})}});
}

// Bars of which each is less than half of the next, and two squares of which one is a bit more.
TEST_CASE("Of more than ten classes, those of the most similar shapes are merged") {
  struct Size {
    int width, height, left, top;
  };
  constexpr Size kSizes[] = {{3, 2, 0, 5},    {7, 2, 0, 10},    {16, 2, 0, 15},   {36, 2, 0, 20},
                             {80, 2, 0, 25},  {2, 4, 0, 35},    {2, 9, 10, 35},   {2, 20, 20, 35},
                             {2, 45, 30, 35}, {12, 12, 0, 100}, {12, 23, 30, 100}};
  ClassDiscovery discovery({}, 8);
  for (int step = 0; step < 60; ++step) {
    DrawnScreen screen;
    for (const Size& size : kSizes)
      for (int row = 0; row < size.height; ++row)
        screen.draw(size.left + step, size.top + row,
                    {std::string(static_cast<std::size_t>(size.width), '#')});
    discovery.add(screen.pixels, step == 0);
  }
  const ObjectClasses classes = discovery.classes();
  REQUIRE(classes.size() == kMaxClasses);
  int merged = 0;
  for (const ObjectClass& one : classes) {
    if (one.size() == 1) continue;
    ++merged;
    REQUIRE(one.size() == 2);
    CHECK(area_of(one[0]) == 12 * 12);
    CHECK(area_of(one[1]) == 12 * 23);
  }
  CHECK(merged == 1);
}

TEST_CASE("Classes are the same again, as text and as a file") {
  const SampleSettings settings{1, 500, 1500, short_episodes()};
  const Background background = discover_background(beamfall(), settings);
  const ObjectClasses classes = discover_classes(beamfall(), settings, background);
  CHECK(!classes.empty());
  CHECK(classes_of_text("a", text_of(classes)) == classes);
  CHECK(classes_of_text("a", "").empty());
  const Scratch folder;
  GameFacts facts(beamfall(), settings, folder.path("."));
  CHECK(facts.classes() == classes);
  const std::string path = folder.path("beamfall.classes");
  CHECK(classes_of(path, background, beamfall(), settings) == classes);
  CHECK(GameFacts(beamfall(), settings, "").classes() == classes);
  CHECK_THROWS_WITH(classes_of(path, Background{}, beamfall(), settings),
                    Catch::StartsWith(path + ": background is '") && Catch::Contains("'; expected '"));
  SampleSettings later = settings;
  later.version = "9.9";
  CHECK_THROWS_WITH(classes_of(path, background, beamfall(), later),
                    Catch::StartsWith(path + ": version is ") && Catch::EndsWith("; expected '9.9'"));
  SampleSettings interpreted = settings;
  interpreted.play.machine.cpu = CpuKind::kInterpreter;
  CHECK(discover_classes(beamfall(), interpreted, background) == classes);
  SampleSettings other = settings;
  other.class_screens = 2;
  CHECK_THROWS_WITH(classes_of(path, background, beamfall(), other),
                    path + ": screens is '1500'; expected '2'");
}

TEST_CASE("An invalid list of classes is refused with its line") {
  const std::string sentence =
      "a:2: it is not the shape of a class; accepted: the number of the class, from 0 to 9 in their "
      "order, and "
      "runs of pixels, ROW,FIRST,LAST";
  for (const std::string line :
       {"2 0,0,1", "x 0,0,1", "0", "0 0,0", "0 0,0,1,2", "0 0,1,0", "0 0,0,160", "0 210,0,1", "0 0,0,1 0,1,2",
        "0 0,0,1 0,2,3", "0 1,0,1", "0 0,1,1", "0 1,0,1 0,0,1", "", "-1 0,0,1", "0 0,0,256",
        "0 0,0,1 210,0,1", "0 0,0,3 1,2,1"})
    CHECK_THROWS_WITH(classes_of_text("a", "0 0,0,1\n" + line + "\n"), sentence);
  CHECK(classes_of_text("a", "0 0,0,159 209,0,0\n").size() == 1);
  std::string eleven;
  for (int number = 0; number < 11; ++number) eleven += std::to_string(number) + " 0,0,1\n";
  CHECK_THROWS_WITH(classes_of_text("a", eleven), Catch::StartsWith("a:11: "));
}

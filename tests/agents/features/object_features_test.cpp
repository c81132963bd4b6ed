#include "agents/features/object_features.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

const Pattern kArrow = {"## ", " ##"}, kArrowTurned = {" ##", "## "};
const Pattern kBlock = {"###", "###", "###"};

ObjectSettings settings(int tilings, int grid, int reach = 8) {
  return {.tilings = tilings, .grid = grid, .reach = reach, .count_instances = true};
}

ObjectClasses two_classes() { return {{shape_of(kArrow)}, {shape_of(kBlock)}}; }

std::map<std::uint32_t, float> features(ObjectFeatures& set, const DrawnScreen& screen) {
  ActiveFeatures active;
  set.extract(screen.pixels, active);
  REQUIRE(active.counts.size() == active.indices.size());
  std::map<std::uint32_t, float> result;
  for (std::size_t i = 0; i < active.indices.size(); ++i)
    REQUIRE(result.emplace(active.indices[i], active.counts[i]).second);
  return result;
}

}  // namespace

TEST_CASE("Tiles are as long as the side divided by the grid, and each tiling is shifted") {
  const TileCoding coding(160, 210, 8, 8);
  CHECK(coding.size() == 8 * 9 * 9);
  CHECK(coding.tile(0, 0, 0) == 0);
  CHECK(coding.tile(0, 19, 26) == 0);
  CHECK(coding.tile(0, 20, 0) == 1);
  CHECK(coding.tile(0, 0, 27) == 9);  // 26.25 pixels
  CHECK(coding.tile(0, 159, 209) == 7 * 9 + 7);
  CHECK(coding.tile(1, 17, 0) == 81);
  CHECK(coding.tile(1, 18, 0) == 82);  // 2.5 pixels to the left
  CHECK(coding.tile(7, 159, 209) == 7 * 81 + 8 * 9 + 8);
}

TEST_CASE("DISCO has a feature for each absent class, tile of a class, and motion and tile of a pair") {
  constexpr std::size_t tiles = 8 * 9 * 9;
  const auto size = [](const ObjectClasses& classes) {
    return ObjectFeatures({}, classes, ObjectSettings()).size();
  };
  CHECK(size(two_classes()) == 2 + 2 * tiles + 9 * 9 * tiles);
  CHECK(size(ObjectClasses(10, {shape_of(kBlock)})) == 10 + 10 * tiles + 45 * 9 * 9 * tiles);
  CHECK(size({}) == 0);
}

TEST_CASE("Every feature of a screen, with one tiling of 2 x 2") {
  // 0 and 1: absent; 2 to 10 and 11 to 19: tiles of both classes; 20 to 100: tiles of the pair
  ObjectFeatures set({}, two_classes(), settings(1, 2));
  REQUIRE(set.size() == 2 + 2 * 9 + 9 * 9);
  using Features = std::map<std::uint32_t, float>;
  CHECK(features(set, DrawnScreen()) == Features{{0, 1}, {1, 1}});
  CHECK(features(set, DrawnScreen().draw(10, 10, kArrow)) == Features{{1, 1}, {2, 1}});
  CHECK(features(set, DrawnScreen().draw(10, 200, kArrowTurned)) == Features{{1, 1}, {2 + 3, 1}});
  // the arrow is at (11, 11), blocks at (101, 11) and (101, 201): to the right, and lower
  const auto three = [](int arrow, int blocks) {
    return DrawnScreen().draw(arrow, 10, kArrow).draw(blocks, 10, kBlock).draw(blocks, 200, kBlock);
  };
  const Features at_rest{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 1, 1}, {20 + 4, 1}};
  CHECK(features(set, three(10, 100)) == at_rest);
  CHECK(
      features(set, three(10, 101)) ==
      Features{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 9 + 1, 1}, {20 + 9 + 4, 1}});  // they go to the right
  CHECK(features(set, three(11, 99)) == at_rest);  // to the left, which is the tile of rest
  set.begin_episode();
  CHECK(features(set, three(10, 100)) == at_rest);
}

TEST_CASE("At most 50 objects of a class count, the largest first") {
  InstanceFinder finder({}, {{shape_of(kArrow), shape_of(kBlock)}}, 8);
  DrawnScreen screen;
  for (int number = 0; number < 60; ++number)
    screen.draw(number % 20 * 8, number / 20 * 8, number < 20 ? kArrow : kBlock);
  const auto& instances = finder.find(screen.pixels);
  REQUIRE(instances.size() == 50);
  CHECK(std::ranges::count(instances, 9, &Instance::area) == 40);
  CHECK(std::ranges::count(instances, 4, &Instance::area) == 10);
  CHECK((instances[0].box.left == 0 && instances[0].box.top == 8));
}

TEST_CASE("Regions are instances where the object that they are joined to is not one") {
  InstanceFinder finder({}, two_classes(), 8);
  const auto screen = [](int x) {
    return DrawnScreen().draw(x, 5, kBlock, 3).draw(x + 3, 5, {"##"}, 4).pixels;
  };
  CHECK(finder.find(screen(10)).size() == 1);
  const auto& joined = finder.find(screen(11));
  REQUIRE(joined.size() == 1);
  CHECK((joined[0].class_number == 1 && joined[0].velocity == Velocity{1, 0}));
}

TEST_CASE("An object that looks different has the velocity with which one of its class came") {
  InstanceFinder finder({}, {{shape_of(kArrow), shape_of(kBlock)}}, 40);
  const auto velocity = [&](int x, int y, Pattern pattern) {
    return finder.find(DrawnScreen().draw(x, y, pattern).pixels)[0].velocity;
  };
  CHECK(velocity(10, 10, kArrow) == Velocity{0, 0});
  CHECK(velocity(30, 5, kBlock) == Velocity{20, -5});  // both centres are a pixel to the right, and below
  CHECK(velocity(20, 5, kArrow) == Velocity{-10, 0});
  CHECK(velocity(61, 5, kBlock) == Velocity{0, 0});  // out of reach
  finder.forget();
  CHECK(velocity(60, 5, kArrow) == Velocity{0, 0});
}

TEST_CASE("An object that looks different came from the nearest object of its class, not of another") {
  InstanceFinder finder({}, {{shape_of(kArrow), shape_of(kBlock)}, {shape_of({"#####"})}}, 8);
  const auto velocity = [&](const DrawnScreen& before) {
    finder.forget();
    finder.find(before.pixels);
    return finder.find(DrawnScreen().draw(50, 50, kBlock).pixels)[0].velocity;
  };
  // The centre of a block at (50, 50) is (51, 51), and that of an arrow there is a pixel above it.
  CHECK(velocity(DrawnScreen().draw(46, 50, kArrow).draw(52, 50, kArrow)).x == -2);
  CHECK(velocity(DrawnScreen().draw(52, 50, kArrow).draw(46, 50, kArrow)).x == -2);
  CHECK(velocity(DrawnScreen().draw(47, 50, kArrow).draw(51, 58, kArrow)).x == 3);
  CHECK(velocity(DrawnScreen().draw(46, 50, kArrow).draw(50, 51, {"#####"})).x == 4);
  CHECK(velocity(DrawnScreen().draw(50, 51, {"#####"})) == Velocity{0, 0});
}

TEST_CASE("The tiles of a pair's velocity select those of its position") {
  // 2 and 2 x 9 features, then 9 x 9 of the pair. Relative velocities from -80 to 80 have tiles of 80.5.
  ObjectFeatures set({}, two_classes(), settings(1, 2, 40));
  REQUIRE(set.size() == 2 + 2 * 9 + 9 * 9);
  const auto motion = [&](int right, int down, int left) {
    set.begin_episode();
    features(set, DrawnScreen().draw(50, 100, kArrow).draw(100, 100, kBlock));
    const auto active =
        features(set, DrawnScreen().draw(50 - left, 100, kArrow).draw(100 + right, 100 + down, kBlock));
    return (active.rbegin()->first - 20) / 9;
  };
  CHECK(motion(0, 0, 0) == 0);
  CHECK(motion(1, 0, 0) == 1);  // to the right
  CHECK(motion(0, 1, 0) == 3);  // down
  CHECK(motion(40, 40, 40) == 4);
  CHECK(motion(-40, 0, -40) == 0);
  CHECK(motion(0, 0, 1) == 1);  // the arrow goes to the left
}

TEST_CASE("A feature of two instances is there once, or twice with counts") {
  for (const bool counted : {false, true}) {
    ObjectSettings one_tile = settings(1, 1);
    one_tile.count_instances = counted;
    ObjectFeatures set({}, two_classes(), one_tile);
    ActiveFeatures active;
    set.extract(DrawnScreen().draw(10, 10, kBlock).draw(30, 10, kBlock).pixels, active);
    CHECK(active.indices == std::vector<std::uint32_t>{0, 2 + 4});
    CHECK(active.counts == (counted ? std::vector<float>{1, 2} : std::vector<float>{}));
  }
}

TEST_CASE("Too many features are refused before they take memory") {
  const ObjectClasses ten(10, {shape_of(kBlock)});
  CHECK(ObjectFeatures({}, ten, settings(64, 64)).size() > std::size_t{40} << 30);
}

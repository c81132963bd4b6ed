#include "agents/features/object_features.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

const Pattern kArrow = {"## ", " ##"}, kArrowTurned = {" ##", "## "};
const Pattern kBlock = {"###", "###", "###"};

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

TEST_CASE("DISCO has a feature for each absent class, tile of a class, and tile of a pair") {
  constexpr std::size_t tiles = 8 * 9 * 9;
  CHECK(ObjectFeatures({}, two_classes(), 8, 8).size() == 2 + 2 * tiles + 4 * tiles);
  CHECK(ObjectFeatures({}, ObjectClasses(10, {shape_of(kBlock)}), 8, 8).size() ==
        10 + 10 * tiles + 45 * 4 * tiles);
  CHECK(ObjectFeatures({}, {}, 8, 8).size() == 0);
}

TEST_CASE("Every feature of a screen, with one tiling of 2 x 2") {
  // 0 and 1: absent; 2 to 10 and 11 to 19: tiles of both classes; 20 to 55: tiles of the pair
  ObjectFeatures set({}, two_classes(), 1, 2);
  REQUIRE(set.size() == 2 + 2 * 9 + 4 * 9);
  using Features = std::map<std::uint32_t, float>;
  CHECK(features(set, DrawnScreen()) == Features{{0, 1}, {1, 1}});
  CHECK(features(set, DrawnScreen().draw(10, 10, kArrow)) == Features{{1, 1}, {2, 1}});
  CHECK(features(set, DrawnScreen().draw(10, 200, kArrowTurned)) == Features{{1, 1}, {2 + 3, 1}});
  // the arrow is at (11, 11), blocks at (101, 11) and (101, 201): to the right, and lower
  const auto three = [](int arrow, int blocks) {
    return DrawnScreen().draw(arrow, 10, kArrow).draw(blocks, 10, kBlock).draw(blocks, 200, kBlock);
  };
  CHECK(features(set, three(10, 100)) ==
        Features{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 1, 1}, {20 + 4, 1}});
  CHECK(features(set, three(11, 99)) ==
        Features{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 9 + 1, 1}, {20 + 9 + 4, 1}});  // they approach in x
  CHECK(features(set, three(10, 100)) ==
        Features{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 1, 1}, {20 + 4, 1}});  // they part
  set.begin_episode();
  CHECK(features(set, three(11, 99)) == Features{{2, 1}, {11 + 1, 1}, {11 + 4, 1}, {20 + 1, 1}, {20 + 4, 1}});
}

TEST_CASE("Objects approach in x, in y, or in both") {
  ObjectFeatures set({}, two_classes(), 1, 1);  // 2 and 2 x 4 features, then 4 x 4 of the pair
  const auto approaches = [&](int right, int down) {
    set.begin_episode();
    features(set, DrawnScreen().draw(10, 10, kArrow).draw(60, 60, kBlock));
    const auto active = features(set, DrawnScreen().draw(10, 10, kArrow).draw(60 + right, 60 + down, kBlock));
    return (active.rbegin()->first - 10) / 4;
  };
  CHECK(approaches(0, 0) == 0);
  CHECK(approaches(3, 3) == 0);
  CHECK(approaches(-3, 3) == 1);
  CHECK(approaches(3, -3) == 2);
  CHECK(approaches(-8, -8) == 3);
  CHECK(approaches(-9, -9) == 0);  // too fast to be followed
}

TEST_CASE("At most 50 objects of a class count, the largest first") {
  InstanceFinder finder({}, {{shape_of(kArrow), shape_of(kBlock)}});
  DrawnScreen screen;
  for (int number = 0; number < 60; ++number)
    screen.draw(number % 20 * 8, number / 20 * 8, number < 20 ? kArrow : kBlock);
  const auto& instances = finder.find(screen.pixels);
  REQUIRE(instances.size() == 50);
  CHECK(std::ranges::count(instances, 9, &Instance::area) == 40);
  CHECK(std::ranges::count(instances, 4, &Instance::area) == 10);
  CHECK((instances[0].box.left == 0 && instances[0].box.top == 8));
}

TEST_CASE("Regions are instances where the object that they are joined to is none") {
  InstanceFinder finder({}, two_classes());
  const auto screen = [](int x) {
    return DrawnScreen().draw(x, 5, kBlock, 3).draw(x + 3, 5, {"##"}, 4).pixels;
  };
  CHECK(finder.find(screen(10)).size() == 1);
  const auto& joined = finder.find(screen(11));
  REQUIRE(joined.size() == 1);
  CHECK((joined[0].class_number == 1 && joined[0].velocity == Velocity{1, 0}));
}

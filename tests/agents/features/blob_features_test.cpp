#include "agents/features/blob_features.hpp"

#include <catch2/catch.hpp>

#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

std::vector<std::uint32_t> features(const RelativeOffsets& set, const ColouredTiles& now,
                                    const ColouredTiles& before = {}) {
  ActiveFeatures active;
  set.extract(now, before, active);
  return active.indices;
}

std::vector<std::uint32_t> features(BlobFeatures& set, const DrawnScreen& screen) {
  ActiveFeatures active;
  set.extract(screen.pixels, active);
  return active.indices;
}

// The parts of Blob-PROST's list: 40 x 30 tiles, 79 x 59 offsets, whose middle is 2330.
constexpr std::uint32_t kOffsets = 79 * 59, kMiddle = 2330;
constexpr std::uint32_t kSpace = 40 * 30 * 128, kOneColour = kSpace + 8128 * kOffsets;
constexpr std::uint32_t kTime = kOneColour + 128 * (kMiddle + 1);

std::uint32_t in_time(std::uint32_t before, std::uint32_t now, std::uint32_t offset) {
  return kTime + (before * 128 + now) * kOffsets + offset;
}

}  // namespace

TEST_CASE("B-PROST and Blob-PROST have the sizes of their paper") {
  CHECK(RelativeOffsets(16, 14).size() == 20598848);
  CHECK(RelativeOffsets(40, 30).size() == 114702400);
  CHECK(BlobFeatures(6).size() == 114702400);
}

TEST_CASE("Every feature of three tiles on two screens, on a grid of 2 x 1") {
  // 256 tiles; 3 offsets: -1, 0, 1; 8,128 x 3 of two colours, 128 x 2 of one; 16,384 x 3 in time
  const RelativeOffsets set(2, 1);
  const std::uint32_t space = 256, one_colour = space + 8128 * 3, time = one_colour + 128 * 2;
  REQUIRE(set.size() == time + 16384 * 3);
  using Features = std::vector<std::uint32_t>;
  CHECK(features(set, {}).empty());
  CHECK(features(set, {{0, 1, 5}}) == Features{128 + 5, one_colour + 2 * 5});
  // colours 0 and 1 are pair 0; from the lower colour to the higher one is a tile to the left
  CHECK(features(set, {{0, 0, 1}, {0, 1, 0}}) == Features{1, 128, space + 0, one_colour + 0, one_colour + 2});
  // one colour in both tiles: without an offset, and with one
  CHECK(features(set, {{0, 0, 1}, {0, 1, 1}}) == Features{1, 129, one_colour + 2, one_colour + 3});
  // from colour 2 in the right tile to colour 0 in the left one
  CHECK(features(set, {{0, 0, 0}}, {{0, 1, 2}}) == Features{0, one_colour, time + 2 * 128 * 3 + 0});
  CHECK(features(set, {{0, 1, 0}}, {{0, 0, 2}}) == Features{128, one_colour, time + 2 * 128 * 3 + 2});
  CHECK(features(set, {{0, 1, 127}}, {{0, 1, 127}}).back() == set.size() - 2);
}

TEST_CASE("Every feature of blobs on one screen and on the next") {
  BlobFeatures set(6);
  using Features = std::vector<std::uint32_t>;
  // The black screen's centre, (80, 105), is in tile (20, 15).
  const std::uint32_t black = (15 * 40 + 20) * 128;
  CHECK(features(set, DrawnScreen()) == Features{black, kOneColour});
  // Two dots of colour 9 are one blob with the centre (11, 14): tile (2, 2). From black to it: -18, -13.
  const auto dots = DrawnScreen().put(8, 14, 9).put(14, 14, 9);
  const std::uint32_t tile = (2 * 40 + 2) * 128 + 9, from_black = kMiddle - 13 * 79 - 18;
  const Features in_space{tile, black, kSpace + 36 * kOffsets + from_black, kOneColour,
                          kOneColour + 9 * (kMiddle + 1)};
  Features both = in_space;
  both.push_back(in_time(0, 0, kMiddle));
  both.push_back(in_time(0, 9, from_black));
  CHECK(features(set, dots) == both);
  set.begin_episode();
  CHECK(features(set, dots) == in_space);
  // The dots are gone: black is as it was, and is seen from where they were.
  CHECK(features(set, DrawnScreen()) ==
        Features{black, kOneColour, in_time(0, 0, kMiddle), in_time(9, 0, kMiddle + 13 * 79 + 18)});
}

TEST_CASE("Two blobs of a colour in one tile are one feature") {
  BlobFeatures set(1);
  const auto active = features(set, DrawnScreen().put(4, 7, 9).put(7, 13, 9));
  CHECK(std::ranges::count(active, (40 + 1) * 128 + 9) == 1);
  CHECK(std::ranges::count(active, kOneColour + 9 * (kMiddle + 1)) == 1);
}

TEST_CASE("A screen of noise has no more tiles than are allowed") {
  DrawnScreen screen;
  for (int pixel = 0; pixel < 160 * 210; ++pixel)
    screen.put(pixel % 160, pixel / 160, pixel * 7919 % 127 + 1);
  BlobFeatures set(1);
  const auto active = features(set, screen);
  const auto tiles = std::ranges::count_if(active, [](std::uint32_t feature) { return feature < kSpace; });
  CHECK(tiles == BlobFeatures::kMaxTiles);
}

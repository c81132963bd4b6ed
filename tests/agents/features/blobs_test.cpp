#include "agents/features/blobs.hpp"

#include <catch2/catch.hpp>

#include "agents/base/random.hpp"
#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

// Blobs of a colour as "LEFT TOP WIDTH HEIGHT".
std::vector<std::string> blobs(const DrawnScreen& screen, int colour, int reach = 6) {
  Blobs finder(reach);
  std::vector<std::string> found;
  for (const Blob& blob : finder.find(screen.pixels)) {
    if (blob.colour != colour) continue;
    const auto [left, top, width, height] = blob.box;
    found.push_back(std::to_string(left) + ' ' + std::to_string(top) + ' ' + std::to_string(width) + ' ' +
                    std::to_string(height));
  }
  return found;
}

using Boxes = std::vector<std::string>;

}  // namespace

TEST_CASE("An empty screen is one blob, and a blob does not hide the one behind it") {
  CHECK(blobs(DrawnScreen(), 0) == Boxes{"0 0 160 210"});
  CHECK(blobs(DrawnScreen().draw(80, 100, {"####", "####"}), 0) == Boxes{"0 0 160 210"});
}

TEST_CASE("Pixels of one colour are one blob up to six pixels apart, in x, in y, and in both") {
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(16, 10, 9), 9) == Boxes{"10 10 7 1"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(17, 10, 9), 9) == Boxes{"10 10 1 1", "17 10 1 1"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(10, 16, 9), 9) == Boxes{"10 10 1 7"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(10, 17, 9), 9) == Boxes{"10 10 1 1", "10 17 1 1"});
  CHECK(blobs(DrawnScreen().put(16, 10, 9).put(10, 16, 9), 9) == Boxes{"10 10 7 7"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(17, 16, 9), 9) == Boxes{"10 10 1 1", "17 16 1 1"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(13, 10, 9), 9, 2) == Boxes{"10 10 1 1", "13 10 1 1"});
}

TEST_CASE("Other colours neither join nor part blobs") {
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(12, 10, 3).put(14, 10, 9), 9) == Boxes{"10 10 5 1"});
  CHECK(blobs(DrawnScreen().put(10, 10, 9).put(13, 10, 3).put(17, 10, 9), 9) ==
        Boxes{"10 10 1 1", "17 10 1 1"});
}

TEST_CASE("Two arms that meet below are one blob") {
  CHECK(blobs(DrawnScreen().draw(0, 0, {"#         #", "#         #", "###########"}), 9) ==
        Boxes{"0 0 11 3"});
}

TEST_CASE("Blobs are those that pixel by pixel comparison gives, on screens of noise") {
  Random random(3);
  for (int count = 0; count < 20; ++count) {
    DrawnScreen screen;
    std::vector<std::pair<int, int>> pixels;
    for (int x = 0; x < 160; ++x)
      for (int y = 0; y < 60; ++y)
        if (random.below(150) == 0) pixels.emplace_back(x, y);
    std::vector<std::size_t> group(pixels.size());  // flood fill
    for (std::size_t i = 0; i < pixels.size(); ++i) group[i] = i;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t j = 0; j < pixels.size(); ++j) {
          const bool near = std::abs(pixels[i].first - pixels[j].first) <= 6 &&
                            std::abs(pixels[i].second - pixels[j].second) <= 6;
          if (near && group[j] > group[i]) {
            group[j] = group[i];
            changed = true;
          }
        }
    }
    std::size_t expected = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) expected += group[i] == i;
    for (const auto& [x, y] : pixels) screen.put(x, y, 9);
    REQUIRE(blobs(screen, 9).size() == expected);
  }
}

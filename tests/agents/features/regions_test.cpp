#include "agents/features/regions.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "agents/base/random.hpp"
#include "tests/agents/features/drawn_screen.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

std::vector<Shape> shapes(const Regions& regions) {
  std::vector<Shape> result;
  for (const Region& region : regions.all()) {
    const ShapeView shape = regions.shape(region);
    result.emplace_back(shape.begin(), shape.end());
  }
  return result;
}

using Touching = std::set<std::pair<std::size_t, std::size_t>>;

// The pairs of regions with pixels beside each other, also at corners. A region is the list of its pixels.
Touching touching_of(const std::vector<std::vector<std::size_t>>& regions) {
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> region_of(kFeaturePixels, kNone);
  for (std::size_t number = 0; number < regions.size(); ++number)
    for (const std::size_t pixel : regions[number]) region_of[pixel] = number;
  Touching pairs;
  for (std::size_t pixel = 0; pixel < kFeaturePixels; ++pixel) {
    const std::size_t x = pixel % kFeatureWidth, y = pixel / kFeatureWidth;
    for (const auto& [right, down] : {std::pair(1, 0), {-1, 1}, {0, 1}, {1, 1}}) {
      const std::size_t column = x + static_cast<std::size_t>(right),
                        row = y + static_cast<std::size_t>(down);
      if (column >= kFeatureWidth || row >= kFeatureHeight) continue;  // -1 is large, too
      const std::size_t one = region_of[pixel], other = region_of[row * kFeatureWidth + column];
      if (one != kNone && other != kNone && one != other) pairs.insert(std::minmax(one, other));
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("Regions are connected pixels of one colour; single pixels are not regions") {
  DrawnScreen screen;
  screen.draw(0, 0, {"# #", "###"}, 5);        // the arms are connected below
  screen.draw(159, 0, {"#", "#"}, 5);          // at the right edge
  screen.draw(10, 3, {"#  ", " ##"}, 5);       // a diagonal connects
  screen.draw(12, 3, {"##"}, 6);               // touches it, in another colour
  screen.draw(0, 1, {"#"}, 5).put(50, 50, 7);  // a single pixel
  screen.draw(150, 209, {"##########"}, 127);  // the last row
  Regions regions({});
  regions.find(screen.pixels);
  CHECK(shapes(regions) == std::vector<Shape>{shape_of({"# #", "###"}), shape_of({"#", "#"}),
                                              shape_of({"#  ", " ##"}), shape_of({"##"}),
                                              shape_of({"##########"})});
  const Region& first = regions.all()[0];
  CHECK(std::tuple(first.box.left, first.box.top, first.box.width, first.box.height, first.area) ==
        std::tuple(0, 0, 3, 2, 5));
  CHECK(regions.all()[4].box.x() == 155);
  for (const auto& pair : regions.touching()) CHECK(pair == std::pair<std::uint32_t, std::uint32_t>{3, 2});
  CHECK(!regions.touching().empty());
}

TEST_CASE("The background is in no region, whatever its colours") {
  Background background;
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel)
    background[pixel] = static_cast<std::uint8_t>(pixel % kColours);
  DrawnScreen screen;
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel)
    screen.pixels[pixel] =
        static_cast<std::uint8_t>(background[pixel] << 1 | 1);  // the lowest bit means nothing
  Regions regions(background);
  regions.find(screen.pixels);
  CHECK(regions.all().empty());
  screen.draw(100, 100, {"##", "##"}, 127);
  regions.find(screen.pixels);
  CHECK(shapes(regions) == std::vector<Shape>{shape_of({"##", "##"})});
}

TEST_CASE("Regions are those that filling finds, on random screens") {
  Random random(4);
  Regions regions({});
  for (int count = 0; count < 30; ++count) {
    DrawnScreen screen;
    for (auto& pixel : screen.pixels) pixel = static_cast<std::uint8_t>(2 * random.below(3));
    regions.find(screen.pixels);
    std::vector<std::vector<std::size_t>> filled;
    std::vector<bool> done(kFeaturePixels);
    for (std::size_t start = 0; start < kFeaturePixels; ++start) {
      if (done[start] || screen.pixels[start] == 0) continue;
      std::vector<std::size_t> region{start};
      done[start] = true;
      for (std::size_t i = 0; i < region.size(); ++i) {
        const int x = static_cast<int>(region[i] % kFeatureWidth),
                  y = static_cast<int>(region[i] / kFeatureWidth);
        for (int down = std::max(y - 1, 0); down <= std::min(y + 1, kFeatureHeight - 1); ++down) {
          for (int right = std::max(x - 1, 0); right <= std::min(x + 1, kFeatureWidth - 1); ++right) {
            const auto at = static_cast<std::size_t>(down * kFeatureWidth + right);
            if (done[at] || screen.pixels[at] != screen.pixels[start]) continue;
            done[at] = true;
            region.push_back(at);
          }
        }
      }
      if (region.size() > 1) filled.push_back(region);
    }
    REQUIRE(regions.all().size() == filled.size());
    for (std::size_t i = 0; i < filled.size(); ++i) {
      REQUIRE(regions.all()[i].area == static_cast<int>(filled[i].size()));
      REQUIRE(area_of(regions.shape(regions.all()[i])) == regions.all()[i].area);
    }
    Touching found;
    for (const auto& [one, other] : regions.touching())
      if (one != other) found.insert(std::minmax<std::size_t>(one, other));
    REQUIRE(found == touching_of(filled));
  }
}

// Smaller pictures by the average of areas.
#include "environment/observe/area_resize.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Rows that repeat, and noise.
Bytes picture(std::mt19937& random, std::size_t width, std::size_t height) {
  Bytes bytes;
  while (bytes.size() < width * height) {
    Bytes row(width);
    for (auto& cell : row) cell = static_cast<std::uint8_t>(random());
    for (auto times = 1 + random() % 6; times > 0; --times) bytes.insert(bytes.end(), row.begin(), row.end());
  }
  bytes.resize(width * height);
  return bytes;
}

TEST_CASE("Every form of the area average gives the same bytes") {
  std::mt19937 random(8);
  const int sizes[][4] = {{160, 210, 84, 84},   {160, 250, 84, 84}, {160, 230, 84, 84}, {160, 210, 100, 50},
                          {160, 210, 160, 210}, {160, 210, 21, 8},  {17, 9, 16, 5},     {7, 9, 3, 2}};
  for (const auto& [width, height, to_width, to_height] : sizes) {
    const Bytes in = picture(random, std::size_t(width), std::size_t(height));
    Bytes best(std::size_t(to_width * to_height)), plain(best.size());
    AreaResize(width, height, to_width, to_height)(in, best);
    AreaResize(width, height, to_width, to_height, Simd::kPlain)(in, plain);
    INFO(width << " x " << height << " to " << to_width << " x " << to_height);
    CHECK(best == plain);
  }
  CHECK_THROWS_WITH(AreaResize(160, 210, 161, 84), Catch::Contains("can't be made 161 x 84"));
  CHECK_THROWS_WITH(AreaResize(160, 210, 84, 7), Catch::Contains("can't be made 84 x 7"));
}

}  // namespace
}  // namespace racebeam

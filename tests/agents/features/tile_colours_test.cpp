#include "agents/features/tile_colours.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "agents/features/ram_bits.hpp"
#include "system/invalid_input.hpp"

using namespace racebeam;

namespace {

using Pixels = std::array<std::uint8_t, kFeaturePixels>;

void put(Pixels& screen, int x, int y, int colour) {
  screen[static_cast<std::size_t>(y * kFeatureWidth + x)] = static_cast<std::uint8_t>(colour << 1);
}

std::vector<std::uint32_t> features(const TileColours& set, const Pixels& screen) {
  ActiveFeatures active;
  set.extract(screen, active);
  return active.indices;
}

}  // namespace

TEST_CASE("The feature sets have the sizes of the paper") {
  CHECK(TileColours({}, 16, 14, 128, false).size() == 28672);
  CHECK(TileColours({}, 16, 14, 8, true).size() == 1792 + 1604736);
  CHECK(RamBits().size() == 1024 + 523776);
}

TEST_CASE("Basic has a feature for each colour in each tile that is not the background") {
  Background background{};
  background.fill(5);
  Pixels screen;
  screen.fill(5 << 1 | 1);  // the lowest bit of an index means nothing
  const TileColours set(background, 16, 14, 128, false);
  CHECK(features(set, screen).empty());
  put(screen, 0, 0, 0);
  put(screen, 9, 14, 127);
  put(screen, 10, 14, 64);   // the second tile
  put(screen, 3, 3, 0);      // a colour counts once a tile
  put(screen, 159, 209, 9);  // the last tile
  put(screen, 0, 15, 63);    // the second row
  CHECK(features(set, screen) == std::vector<std::uint32_t>{0, 127, 128 + 64, 16 * 128 + 63, 223 * 128 + 9});
}

TEST_CASE("BASS compares the background before it reduces colours") {
  Background background{};
  background.fill(8);
  Pixels screen;
  screen.fill(8 << 1);
  put(screen, 0, 0, 16);  // of SECAM's colour 0, as the background
  put(screen, 1, 0, 23);  // 7
  put(screen, 12, 0, 15);
  const TileColours set(background, 16, 14, 8, true);
  CHECK(features(set, screen) == std::vector<std::uint32_t>{0, 7, 15, 1792 + 21, 1792 + 105, 1792 + 112});
}

TEST_CASE("The index of a pair hits each place once") {
  std::vector<bool> hit(pairs_of(1792));
  for (std::uint32_t j = 1; j < 1792; ++j) {
    for (std::uint32_t i = 0; i < j; ++i) {
      REQUIRE(!hit.at(pair_index(i, j)));
      hit[pair_index(i, j)] = true;
    }
  }
  CHECK(hit.size() == 1604736);
  CHECK(std::ranges::count(hit, true) == 1604736);
}

TEST_CASE("RAM has the bits that are set, and their pairs") {
  std::array<std::uint8_t, kRamSize> ram{};
  ram[0] = 0b101;
  ram[127] = 0x80;
  ActiveFeatures active;
  RamBits().extract(ram, active);
  CHECK(active.indices ==
        std::vector<std::uint32_t>{0, 2, 1023, 1024 + 1, 1024 + 1023 * 1022 / 2, 1024 + 1023 * 1022 / 2 + 2});
  ram.fill(0xFF);
  RamBits().extract(ram, active);
  const std::set<std::uint32_t> all(active.indices.begin(), active.indices.end());
  CHECK(all.size() == RamBits().size());
  CHECK(*all.rbegin() == RamBits().size() - 1);
}

TEST_CASE("A grid that does not divide the screen is refused") {
  CHECK_THROWS_WITH(TileColours({}, 17, 14, 128, false),
                    "grid_width is 17; it must divide the screen's 160 pixels");
  CHECK_THROWS_AS(TileColours({}, 16, 0, 128, false), InvalidInput);
}

#include "agents/features/tile_colours.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::uint64_t kNoLowestBits = 0xFEFEFEFEFEFEFEFE;
constexpr int kSecamColours = 8;

int tile_size(int screen, int tiles, const char* what) {
  if (tiles < 1 || screen % tiles != 0)
    throw InvalidInput(std::string(what) + " is " + std::to_string(tiles) + "; it must divide the screen's " +
                       std::to_string(screen) + " pixels");
  return screen / tiles;
}

std::uint64_t word_at(const std::uint8_t* at) {
  std::uint64_t word;
  std::memcpy(&word, at, sizeof word);
  return word;
}

}  // namespace

// 128 bits, one for each colour.
struct TileColours::ColourSet {
  std::uint64_t low = 0, high = 0;
  void add(std::uint8_t colour) { (colour < 64 ? low : high) |= std::uint64_t{1} << (colour & 63); }
};

TileColours::TileColours(const Background& background, int grid_width, int grid_height, int colours,
                         bool pairs)
    : grid_width_(grid_width),
      tile_width_(tile_size(kFeatureWidth, grid_width, "grid_width")),
      tile_height_(tile_size(kFeatureHeight, grid_height, "grid_height")),
      colours_(colours),
      tiles_(static_cast<std::size_t>(grid_width) * static_cast<std::size_t>(grid_height) *
             static_cast<std::size_t>(colours)),
      pairs_(pairs) {
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel)
    background_[pixel] = static_cast<std::uint8_t>(background[pixel] << 1);
  for (std::size_t column = 0; column < tile_of_column_.size(); ++column)
    tile_of_column_[column] = static_cast<std::uint8_t>(column / static_cast<std::size_t>(tile_width_));
}

// Most pixels are the background's: they are passed over eight at a time.
void TileColours::mark_row(const std::uint8_t* pixels, std::size_t first_pixel, ColourSet* tiles) const {
  const std::uint8_t* const behind = background_.data() + first_pixel;
  for (std::size_t x = 0; x < kFeatureWidth; x += 8) {
    std::uint64_t differs = (word_at(pixels + x) ^ word_at(behind + x)) & kNoLowestBits;
    while (differs != 0) {
      const auto byte = static_cast<std::size_t>(std::countr_zero(differs)) / 8;
      const std::uint8_t colour = colour_of(pixels[x + byte]);
      tiles[tile_of_column_[x + byte]].add(colours_ == kSecamColours ? secam_of(colour) : colour);
      differs &= ~(std::uint64_t{0xFF} << (8 * byte));
    }
  }
}

void TileColours::extract(Screen screen, ActiveFeatures& active) const {
  active.clear();
  std::uint32_t first = 0;
  for (int top = 0; top < kFeatureHeight; top += tile_height_) {
    std::array<ColourSet, kFeatureWidth> tiles{};
    for (int row = top; row < top + tile_height_; ++row) {
      const auto pixel = static_cast<std::size_t>(row) * kFeatureWidth;
      mark_row(screen.data() + pixel, pixel, tiles.data());
    }
    for (int column = 0; column < grid_width_; ++column, first += static_cast<std::uint32_t>(colours_)) {
      const ColourSet& tile = tiles[static_cast<std::size_t>(column)];
      for (std::uint64_t bits = tile.low; bits != 0; bits &= bits - 1)
        active.indices.push_back(first + static_cast<std::uint32_t>(std::countr_zero(bits)));
      for (std::uint64_t bits = tile.high; bits != 0; bits &= bits - 1)
        active.indices.push_back(first + 64 + static_cast<std::uint32_t>(std::countr_zero(bits)));
    }
  }
  if (pairs_) append_pairs(active, static_cast<std::uint32_t>(tiles_));
}

}  // namespace racebeam

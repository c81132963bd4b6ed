// Basic and BASS: which colours are in which tile of the screen, without the background (appendices A.1 and
// A.2 of the paper).
#pragma once

#include "agents/features/background.hpp"
#include "agents/features/feature_set.hpp"

namespace racebeam {

class TileColours final : public FeatureSet {
 public:
  // `colours` is 128, or 8 for SECAM's. The width and height of the grid divide those of the screen. With
  // `pairs`, all pairs of features are features, too. Throws InvalidInput.
  TileColours(const Background& background, int grid_width, int grid_height, int colours, bool pairs);

  std::size_t size() const override { return tiles_ + (pairs_ ? pairs_of(tiles_) : 0); }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }
  // Feature (tile row * grid width + tile column) * colours + colour.
  void extract(Screen screen, ActiveFeatures& active) const;

 private:
  struct ColourSet;
  void mark_row(const std::uint8_t* pixels, std::size_t first_pixel, ColourSet* tiles) const;

  Background background_;  // palette indices with the lowest bit clear
  const int grid_width_, tile_width_, tile_height_, colours_;
  const std::size_t tiles_;  // features of single tiles
  const bool pairs_;
  std::array<std::uint8_t, kFeatureWidth> tile_of_column_;
  FeatureScreen screen_;
};

}  // namespace racebeam

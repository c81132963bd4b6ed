// Blob-PROST: the tiles in which the centres of blobs are, and their offsets in space and in time (Liang et
// al. 2016; docs/paper-notes.md, "Successors").
#pragma once

#include "agents/features/blobs.hpp"
#include "agents/features/relative_offsets.hpp"

namespace racebeam {

class BlobFeatures final : public FeatureSet {
 public:
  static constexpr std::size_t kMaxTiles = 1000;

  explicit BlobFeatures(int reach) : blobs_(reach), offsets_(kColumns, kRows) {}

  std::size_t size() const override { return offsets_.size(); }
  void begin_episode() override { now_.clear(); }
  void extract(const Environment& machine, ActiveFeatures& active) override {
    extract(screen_.of(machine), active);
  }

  // RelativeOffsets says the order. The first screen of an episode has no offsets in time. The first
  // kMaxTiles of a screen count: the number of pairs grows with their square.
  void extract(Screen screen, ActiveFeatures& active);

 private:
  static constexpr int kTileWidth = 4, kTileHeight = 7;
  static constexpr int kColumns = kFeatureWidth / kTileWidth, kRows = kFeatureHeight / kTileHeight;

  Blobs blobs_;
  const RelativeOffsets offsets_;
  ColouredTiles now_, before_;
  FeatureScreen screen_;
};

}  // namespace racebeam

#include "agents/features/blob_features.hpp"

#include <algorithm>
#include <utility>

namespace racebeam {

void BlobFeatures::extract(Screen screen, ActiveFeatures& active) {
  std::swap(now_, before_);
  now_.clear();
  for (const Blob& blob : blobs_.find(screen))
    now_.push_back({blob.box.y() / kTileHeight, blob.box.x() / kTileWidth, blob.colour});
  std::ranges::sort(now_);
  now_.erase(std::unique(now_.begin(), now_.end()), now_.end());
  if (now_.size() > kMaxTiles) now_.resize(kMaxTiles);
  offsets_.extract(now_, before_, active);
}

}  // namespace racebeam

#include "emulator/tia/line_cache/flicker_detector.hpp"

#include <algorithm>
#include <cstdint>

namespace racebeam {

void FlickerDetector::begin_frame() {
  odd_ = !odd_;
  if (++frame_ == period_) frame_ = 0;
  if (frame_ == kFirst) alike_ = drawn_with_one_ = 0;
  if (frame_ == kLast + 1) judge();
  if (frame_ == period_ - 2) drawn_with_two_ = 0;
  counts_ = (frame_ >= kFirst && frame_ <= kLast) || frame_ >= period_ - 2;
}

void FlickerDetector::judge() {
  const bool found = found_ ? drawn_with_two_ < drawn_with_one_ : alike_ >= tuning::kFlickeringRows;
  period_ =
      found == found_ ? std::min(2 * period_, tuning::kLongestFlickerPeriod) : tuning::kShortestFlickerPeriod;
  found_ = found;
}

void FlickerDetector::count(LineRecord& record) {
  if (frame_ > kLast) {
    ++drawn_with_two_;
    return;
  }
  std::uint8_t& before = record.hashes[odd_ ? 1 : 0];
  const std::uint8_t hash = record.hash();
  if (frame_ >= kAgain) {
    ++drawn_with_one_;
    if (hash == before) ++alike_;
  }
  before = hash;
}

}  // namespace racebeam

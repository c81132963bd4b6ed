#include "emulator/flicker.hpp"

#include <algorithm>

namespace racebeam {

void Flicker::begin_frame(std::size_t rows) {
  odd_ = !odd_;
  if (++frame_ == period_) frame_ = 0;
  if (frame_ == kFirst) {
    for (auto& looks : looks_) looks.assign(rows, 0);
    alike_ = drawn_with_one_ = 0;
  }
  if (frame_ == kLast + 1) judge();
  if (frame_ == period_ - 2) drawn_with_two_ = 0;
  counts_ = (frame_ >= kFirst && frame_ <= kLast) || frame_ >= period_ - 2;
}

void Flicker::judge() {
  const bool found = found_ ? drawn_with_two_ < drawn_with_one_ : alike_ >= kMany;
  period_ = found == found_ ? std::min(2 * period_, kLongPeriod) : kShortPeriod;
  found_ = found;
}

void Flicker::count(const LineRecord& drawn, std::size_t row) {
  if (frame_ > kLast) {
    ++drawn_with_two_;
    return;
  }
  std::uint16_t& before = looks_[odd_ ? 1 : 0][row];
  const std::uint16_t look = drawn.look();
  if (frame_ >= kAgain) {
    ++drawn_with_one_;
    if (look == before) ++alike_;
  }
  before = look;
}

}  // namespace racebeam

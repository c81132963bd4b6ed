#include "environment/preprocess.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "emulator/palette.hpp"

namespace racebeam {

AreaResize::AreaResize(int width, int height, int to_width, int to_height)
    : width_(static_cast<std::size_t>(width)),
      columns_(width, to_width),
      rows_(height, to_height),
      reduced_(static_cast<std::size_t>(to_width)),
      sum_(reduced_.size()) {}

// A sliver under a thousandth of a cell counts as none. Weights of zero fill up to the same number of taps
// for all targets; they change no sum.
AreaResize::Axis::Axis(int cells, int targets)
    : taps(std::min(static_cast<std::size_t>(cells / targets) + 2, static_cast<std::size_t>(cells))),
      weights(static_cast<std::size_t>(targets) * taps) {
  constexpr double kSliver = 1e-3;
  const double scale = static_cast<double>(cells) / targets;
  const std::size_t last_first = static_cast<std::size_t>(cells) - taps;
  for (int target = 0; target < targets; ++target) {
    const double begin = target * scale, end = begin + scale;
    const double covered = std::min(scale, cells - begin);
    const int whole_end = std::min(static_cast<int>(std::floor(end)), cells - 1);
    const int whole_begin = std::min(static_cast<int>(std::ceil(begin)), whole_end);
    const bool sliver_before = whole_begin - begin > kSliver;
    first.push_back(std::min(static_cast<std::size_t>(whole_begin - sliver_before), last_first));
    const auto add = [&](int cell, double weight) {
      weights[first.size() * taps - taps + static_cast<std::size_t>(cell) - first.back()] =
          static_cast<float>(weight / covered);
    };
    if (sliver_before) add(whole_begin - 1, whole_begin - begin);
    for (int cell = whole_begin; cell < whole_end; ++cell) add(cell, 1);
    if (end - whole_end > kSliver) add(whole_end, std::min({end - whole_end, 1.0, covered}));
  }
}

void AreaResize::reduce(const std::uint8_t* row) {
  const float* weight = columns_.weights.data();
  for (std::size_t x = 0; x < reduced_.size(); ++x) {
    const std::uint8_t* const cells = row + columns_.first[x];
    float sum = 0;
    for (std::size_t tap = 0; tap < columns_.taps; ++tap) sum += static_cast<float>(cells[tap]) * *weight++;
    reduced_[x] = sum;
  }
}

void AreaResize::operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  const std::uint8_t* reduced_row = nullptr;  // what reduced_ was made from; rows that repeat are common
  for (std::size_t y = 0; y < rows_.first.size(); ++y) {
    std::ranges::fill(sum_, 0.0F);
    for (std::size_t tap = 0; tap < rows_.taps; ++tap) {
      const float weight = rows_.weights[y * rows_.taps + tap];
      if (weight == 0) continue;
      const std::uint8_t* row = in.data() + (rows_.first[y] + tap) * width_;
      if (reduced_row == nullptr || std::memcmp(row, reduced_row, width_) != 0) reduce(row);
      reduced_row = row;
      for (std::size_t x = 0; x < sum_.size(); ++x) sum_[x] += weight * reduced_[x];
    }
    std::uint8_t* row = out.data() + y * sum_.size();
    // Half to even, as the processor rounds.
    for (std::size_t x = 0; x < sum_.size(); ++x) row[x] = static_cast<std::uint8_t>(std::lrintf(sum_[x]));
  }
}

SmallScreens::SmallScreens(int depth, int height)
    : resize_(kScreenWidth, height, kSmallSide, kSmallSide),
      bytes_(static_cast<std::size_t>(depth) * kSmallSize) {}

void SmallScreens::clear() { std::ranges::fill(bytes_, std::uint8_t{0}); }

void SmallScreens::push(const Environment& environment, bool pooled) {
  environment.screen_grey(grey_);
  if (pooled) {
    const GreyTable& table = grey_table(environment.format());
    const auto previous = environment.previous_screen();
    for (std::size_t i = 0; i < grey_.size(); ++i) grey_[i] = std::max(grey_[i], table[previous[i]]);
  }
  std::shift_left(bytes_.begin(), bytes_.end(), kSmallSize);
  resize_(grey_, std::span(bytes_).last(kSmallSize));
}

void SmallScreens::set_bytes(std::span<const std::uint8_t> bytes) {
  std::ranges::copy(bytes, bytes_.begin());
}

}  // namespace racebeam

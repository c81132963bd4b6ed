#include "environment/preprocess.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "emulator/palette.hpp"

namespace racebeam {

AreaResize::AreaResize(int width, int height, int to_width, int to_height)
    : width_(static_cast<std::size_t>(width)),
      to_width_(static_cast<std::size_t>(to_width)),
      columns_(taps(width, to_width)),
      rows_(taps(height, to_height)),
      reduced_(to_width_),
      sum_(to_width_) {}

// One axis, in the order in which the contributions are summed. A sliver under a thousandth counts as none.
std::vector<AreaResize::Tap> AreaResize::taps(int cells, int targets) {
  constexpr double kSliver = 1e-3;
  const double scale = static_cast<double>(cells) / targets;
  std::vector<Tap> all;
  for (int to = 0; to < targets; ++to) {
    const double first = to * scale, last = first + scale;
    const double covered = std::min(scale, cells - first);
    const int whole_end = std::min(static_cast<int>(std::floor(last)), cells - 1);
    const int whole_begin = std::min(static_cast<int>(std::ceil(first)), whole_end);
    const auto add = [&](int from, double weight) {
      all.push_back({from, to, static_cast<float>(weight / covered)});
    };
    if (whole_begin - first > kSliver) add(whole_begin - 1, whole_begin - first);
    for (int from = whole_begin; from < whole_end; ++from) add(from, 1);
    if (last - whole_end > kSliver) add(whole_end, std::min({last - whole_end, 1.0, covered}));
  }
  return all;
}

void AreaResize::reduce(const std::uint8_t* row) {
  std::ranges::fill(reduced_, 0.0F);
  for (const Tap& tap : columns_) {
    reduced_[static_cast<std::size_t>(tap.to)] += static_cast<float>(row[tap.from]) * tap.weight;
  }
}

void AreaResize::operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  const std::uint8_t* reduced_row = nullptr;  // what reduced_ was made from; rows that repeat are common
  for (std::size_t tap = 0; tap < rows_.size();) {
    const int to = rows_[tap].to;
    std::ranges::fill(sum_, 0.0F);
    for (; tap < rows_.size() && rows_[tap].to == to; ++tap) {
      const std::uint8_t* row = in.data() + static_cast<std::size_t>(rows_[tap].from) * width_;
      if (reduced_row == nullptr || std::memcmp(row, reduced_row, width_) != 0) reduce(row);
      reduced_row = row;
      for (std::size_t x = 0; x < to_width_; ++x) sum_[x] += rows_[tap].weight * reduced_[x];
    }
    std::uint8_t* row = out.data() + static_cast<std::size_t>(to) * to_width_;
    // Half to even, as the processor rounds.
    for (std::size_t x = 0; x < to_width_; ++x) row[x] = static_cast<std::uint8_t>(std::lrintf(sum_[x]));
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

void SmallScreens::set_bytes(std::span<const std::uint8_t> bytes) { std::ranges::copy(bytes, bytes_.begin()); }

}  // namespace racebeam

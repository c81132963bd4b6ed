#include "agents/features/relative_offsets.hpp"

#include <algorithm>

namespace racebeam {
namespace {

constexpr std::uint32_t kPairsOfColours = static_cast<std::uint32_t>(pairs_of(kColours));

}  // namespace

RelativeOffsets::RelativeOffsets(int columns, int rows)
    : columns_(columns),
      rows_(rows),
      offsets_(static_cast<std::uint32_t>((2 * columns - 1) * (2 * rows - 1))),
      no_offset_(offsets_ / 2),
      first_in_space_(static_cast<std::uint32_t>(columns * rows * kColours)),
      first_of_one_colour_(first_in_space_ + kPairsOfColours * offsets_),
      first_in_time_(first_of_one_colour_ + kColours * (no_offset_ + 1)) {}

void RelativeOffsets::extract(std::span<const ColouredTile> now, std::span<const ColouredTile> before,
                              ActiveFeatures& active) const {
  active.clear();
  std::vector<std::uint32_t>& features = active.indices;
  for (const auto& [row, column, colour] : now)
    features.push_back(static_cast<std::uint32_t>((row * columns_ + column) * kColours + colour));
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) features.push_back(in_space(now[j], now[i]));
  for (const ColouredTile& earlier : before)
    for (const ColouredTile& later : now) features.push_back(in_time(earlier, later));
  const auto pairs = features.begin() + static_cast<std::ptrdiff_t>(now.size());
  std::sort(pairs, features.end());
  features.erase(std::unique(pairs, features.end()), features.end());
}

// From 0 to offsets_ - 1. The opposite offset is as far from the other end.
std::uint32_t RelativeOffsets::offset(const ColouredTile& from, const ColouredTile& to) const {
  const int down = to.row - from.row + rows_ - 1, right = to.column - from.column + columns_ - 1;
  return static_cast<std::uint32_t>(down * (2 * columns_ - 1) + right);
}

std::uint32_t RelativeOffsets::in_space(const ColouredTile& one, const ColouredTile& other) const {
  if (one.colour > other.colour) return in_space(other, one);
  const std::uint32_t between = offset(one, other);
  if (one.colour != other.colour)
    return first_in_space_ + pair_index(one.colour, other.colour) * offsets_ + between;
  const std::uint32_t without_sign = between < no_offset_ ? no_offset_ - between : between - no_offset_;
  return first_of_one_colour_ + one.colour * (no_offset_ + 1) + without_sign;
}

std::uint32_t RelativeOffsets::in_time(const ColouredTile& before, const ColouredTile& now) const {
  return first_in_time_ + (before.colour * std::uint32_t{kColours} + now.colour) * offsets_ +
         offset(before, now);
}

}  // namespace racebeam

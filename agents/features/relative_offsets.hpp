// PROST: coloured tiles, and the offsets between any two of them, in space and in time (Liang et al. 2016;
// docs/paper-notes.md, "Successors").
#pragma once

#include <compare>
#include <span>

#include "agents/features/feature_set.hpp"
#include "agents/features/screen.hpp"

namespace racebeam {

// A tile of the screen, and a colour that it has.
struct ColouredTile {
  int row, column;
  std::uint8_t colour;
  // NOLINTNEXTLINE(modernize-use-nullptr): a fault of clang-tidy 14
  auto operator<=>(const ColouredTile&) const = default;
};
using ColouredTiles = std::vector<ColouredTile>;

class RelativeOffsets {
 public:
  RelativeOffsets(int columns, int rows);  // of tiles

  std::size_t size() const { return first_in_time_ + std::size_t{kColours} * kColours * offsets_; }

  // The tiles ascend, each once; `before` are those of the screen before. Features, in this order:
  // - each tile of `now`: (row * columns + column) * colours + colour;
  // - each pair of `now`, a tile and itself included: two colours, and the offset from the lower colour's to
  //   the higher one's tile; of one colour, the offset without its sign;
  // - each tile of `before` with each of `now`: both colours, and the offset from the earlier to the later.
  void extract(std::span<const ColouredTile> now, std::span<const ColouredTile> before,
               ActiveFeatures& active) const;

 private:
  std::uint32_t offset(const ColouredTile& from, const ColouredTile& to) const;
  std::uint32_t in_space(const ColouredTile& one, const ColouredTile& other) const;
  std::uint32_t in_time(const ColouredTile& before, const ColouredTile& now) const;

  const int columns_, rows_;
  const std::uint32_t offsets_;  // their number
  const std::uint32_t no_offset_;
  const std::uint32_t first_in_space_, first_of_one_colour_, first_in_time_;
};

}  // namespace racebeam

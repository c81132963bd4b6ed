// A picture as text for a terminal with 24-bit colours: each cell shows two pixels, one above the other.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "cli/terminal/picture.hpp"

namespace racebeam {

struct Cell {
  std::array<unsigned, 3> upper, lower;  // red, green, blue
  bool operator==(const Cell&) const = default;
};

struct Cells {
  std::size_t columns = 0;
  std::vector<Cell> cells;
};

// The largest picture for the room, at most 320 columns wide. Its height keeps the proportions of a
// television, on which a pixel is twice as wide as high, if a cell is twice as high as wide.
Cells cells_of(const TerminalPicture& picture, const Room& room);

// Rows of text, each with a newline.
std::string as_lines(const Cells& cells);

// What turns `before`, in the terminal's upper left corner, into `now`. If they differ in size, all of `now`.
std::string as_changes(const Cells& before, const Cells& now);

}  // namespace racebeam

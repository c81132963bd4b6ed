#include "cli/terminal/half_blocks.hpp"

#include <algorithm>
#include <optional>

namespace racebeam {
namespace {

using Colour = std::array<unsigned, 3>;

constexpr std::size_t kMaxColumns = 2 * kPixelsARow;
constexpr int kCharacter = 38, kBehindIt = 48;  // the two colours of a cell
constexpr auto kUpperHalf = "\u2580";

// The mean of the pixels in a part of the screen, which has at least one.
Colour mean(const TerminalPicture& picture, std::size_t left, std::size_t right, std::size_t top,
            std::size_t bottom) {
  Colour sum{};
  for (std::size_t y = top; y < bottom; ++y) {
    for (std::size_t x = left; x < right; ++x) {
      const auto colour = picture.colour(picture.pixels[y * kPixelsARow + x]);
      for (std::size_t part = 0; part < sum.size(); ++part) sum[part] += colour[part];
    }
  }
  for (unsigned& part : sum) part /= static_cast<unsigned>((right - left) * (bottom - top));
  return sum;
}

void select(std::string& text, int layer, const Colour& colour) {
  text.append("\x1b[").append(std::to_string(layer)).append(";2");
  for (const unsigned part : colour) text.append(";").append(std::to_string(part));
  text.append("m");
}

void move_to(std::string& text, std::size_t column, std::size_t row) {
  text.append("\x1b[")
      .append(std::to_string(row + 1))
      .append(";")
      .append(std::to_string(column + 1))
      .append("H");
}

// Writes cells one after the other. Selects a colour only where it changes.
class Pen {
 public:
  void write(std::string& text, const Cell& cell) {
    if (upper_ != cell.upper) select(text, kCharacter, *(upper_ = cell.upper));
    if (lower_ != cell.lower) select(text, kBehindIt, *(lower_ = cell.lower));
    text.append(kUpperHalf);
  }

 private:
  std::optional<Colour> upper_, lower_;
};

}  // namespace

Cells cells_of(const TerminalPicture& picture, const Room& room) {
  const std::size_t height = picture.height();
  const std::size_t columns =
      std::clamp<std::size_t>(std::min(room.columns, 4 * room.rows * kPixelsARow / height), 1, kMaxColumns);
  const std::size_t rows = std::max<std::size_t>(2, columns * height / (2 * kPixelsARow) / 2 * 2);
  const auto block = [&](std::size_t column, std::size_t row) {
    const std::size_t left = column * kPixelsARow / columns, top = row * height / rows;
    return mean(picture, left, std::max(left + 1, (column + 1) * kPixelsARow / columns), top,
                std::max(top + 1, (row + 1) * height / rows));
  };
  Cells cells{.columns = columns, .cells = {}};
  for (std::size_t row = 0; row < rows; row += 2)
    for (std::size_t column = 0; column < columns; ++column)
      cells.cells.push_back({block(column, row), block(column, row + 1)});
  return cells;
}

std::string as_lines(const Cells& cells) {
  std::string text;
  for (std::size_t row = 0; row < cells.cells.size(); row += cells.columns) {
    Pen pen;
    for (std::size_t at = row; at < row + cells.columns; ++at) pen.write(text, cells.cells[at]);
    text.append("\x1b[0m\n");
  }
  return text;
}

std::string as_changes(const Cells& before, const Cells& now) {
  const bool same_size = before.columns == now.columns && before.cells.size() == now.cells.size();
  std::string text;
  Pen pen;
  std::size_t cursor = now.cells.size();  // the cell that it is at; initially none
  for (std::size_t at = 0; at < now.cells.size(); ++at) {
    if (same_size && before.cells[at] == now.cells[at]) continue;
    const std::size_t column = at % now.columns;
    if (cursor != at || column == 0) move_to(text, column, at / now.columns);
    pen.write(text, now.cells[at]);
    cursor = at + 1;
  }
  return text.empty() ? text : text.append("\x1b[0m");
}

}  // namespace racebeam

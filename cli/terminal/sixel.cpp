#include "cli/terminal/sixel.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

constexpr std::size_t kBandHeight = 6;
constexpr std::size_t kShortestRun = 4;  // "!4?" is as long as what it replaces
constexpr char kNoPixel = '?';           // the character of six pixels that stay as they are

// For each value of a pixel, the six pixels of each column that have it, as bits, the uppermost first.
using Band = std::array<std::array<std::uint8_t, kPixelsARow>, 256>;

std::string colours_of(const TerminalPicture& picture, const std::array<bool, 256>& used) {
  std::string text;
  for (std::size_t value = 0; value < used.size(); ++value) {
    if (!used[value]) continue;
    text.append("#").append(std::to_string(value)).append(";2");
    for (const unsigned part : picture.colour(value))
      text.append(";").append(std::to_string((part * 100 + 127) / 255));  // percent
  }
  return text;
}

// The columns of a colour in a band, each `width` pixels wide, as runs.
void write_runs(std::string& text, const std::array<std::uint8_t, kPixelsARow>& columns, std::size_t width) {
  std::size_t end = columns.size();
  while (end > 0 && columns[end - 1] == 0) --end;
  for (std::size_t at = 0; at < end;) {
    const auto next = std::find_if(columns.begin() + static_cast<std::ptrdiff_t>(at),
                                   columns.begin() + static_cast<std::ptrdiff_t>(end),
                                   [&](std::uint8_t bits) { return bits != columns[at]; });
    const auto stop = static_cast<std::size_t>(next - columns.begin());
    const std::size_t run = (stop - at) * width;
    const auto character = static_cast<char>(kNoPixel + columns[at]);
    if (run < kShortestRun) {
      text.append(run, character);
    } else {
      text.append("!").append(std::to_string(run)).append(1, character);
    }
    at = stop;
  }
}

// Six rows of the enlarged picture, from `top` on.
void write_band(std::string& text, const TerminalPicture& picture, std::size_t top, std::size_t scale) {
  Band band{};
  std::array<bool, 256> used{};
  for (std::size_t bit = 0; bit < kBandHeight; ++bit) {
    const std::size_t row = (top + bit) / scale;
    if (row >= picture.height()) break;
    for (std::size_t column = 0; column < kPixelsARow; ++column) {
      const std::uint8_t value = picture.pixels[row * kPixelsARow + column];
      band[value][column] |= static_cast<std::uint8_t>(1 << bit);
      used[value] = true;
    }
  }
  for (std::size_t value = 0; value < used.size(); ++value) {
    if (!used[value]) continue;
    text.append("#").append(std::to_string(value));
    write_runs(text, band[value], 2 * scale);
    text.append("$");  // back to the left
  }
  text.append("-");  // the next band
}

}  // namespace

std::string sixel(const TerminalPicture& picture, const Room& room) {
  const std::size_t across = room.columns * room.cell_width / (2 * kPixelsARow);
  const std::size_t down = room.rows * room.cell_height / picture.height();
  const std::size_t scale = std::max<std::size_t>(1, std::min(across, down));
  const std::size_t height = scale * picture.height();
  std::array<bool, 256> used{};
  for (const std::uint8_t value : picture.pixels) used[value] = true;
  std::string text = "\x1bP0;1;0q\"1;1;";
  text.append(std::to_string(2 * scale * kPixelsARow)).append(";").append(std::to_string(height));
  text.append(colours_of(picture, used));
  for (std::size_t top = 0; top < height; top += kBandHeight) write_band(text, picture, top, scale);
  return text.append("\x1b\\");
}

}  // namespace racebeam

#include "cli/connect/half_blocks.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

constexpr std::size_t kWidth = 160;

using Colour = std::array<unsigned, 3>;

// The mean of the pixels in a part of the screen, which has at least one.
Colour mean(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> colours, std::size_t left,
            std::size_t right, std::size_t top, std::size_t bottom) {
  Colour sum{};
  for (std::size_t y = top; y < bottom; ++y) {
    for (std::size_t x = left; x < right; ++x) {
      for (std::size_t part = 0; part < sum.size(); ++part)
        sum[part] += colours[3 * std::size_t{screen[y * kWidth + x]} + part];
    }
  }
  for (unsigned& part : sum) part /= static_cast<unsigned>((right - left) * (bottom - top));
  return sum;
}

// The escape sequence that selects a colour: of the character (38) or of what is behind it (48).
std::string select(int layer, const Colour& colour) {
  std::string text = "\x1b[" + std::to_string(layer) + ";2";
  for (const unsigned part : colour) text.append(";").append(std::to_string(part));
  return text.append("m");
}

}  // namespace

std::string half_blocks(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> colours,
                        std::size_t columns) {
  const std::size_t height = screen.size() / kWidth;
  const std::size_t rows = std::max<std::size_t>(2, columns * height / (2 * kWidth) / 2 * 2);
  const auto block = [&](std::size_t column, std::size_t row) {
    const std::size_t left = column * kWidth / columns, top = row * height / rows;
    return mean(screen, colours, left, std::max(left + 1, (column + 1) * kWidth / columns), top,
                std::max(top + 1, (row + 1) * height / rows));
  };
  std::string text;
  for (std::size_t row = 0; row < rows; row += 2) {
    for (std::size_t column = 0; column < columns; ++column)
      text.append(select(38, block(column, row))).append(select(48, block(column, row + 1))).append("\u2580");
    text.append("\x1b[0m\n");
  }
  return text;
}

}  // namespace racebeam

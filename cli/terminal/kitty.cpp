#include "cli/terminal/kitty.hpp"

#include <zlib.h>

#include <algorithm>
#include <racebeam/client/encoding.hpp>
#include <stdexcept>

namespace racebeam {
namespace {

constexpr std::size_t kMaxCharacters = 4096;  // of the data of one sequence

std::vector<std::uint8_t> packed_colours(const TerminalPicture& picture) {
  std::vector<std::uint8_t> colours;
  colours.reserve(3 * picture.pixels.size());
  for (const std::uint8_t value : picture.pixels) {
    const auto colour = picture.colour(value);
    colours.insert(colours.end(), colour.begin(), colour.end());
  }
  uLongf size = compressBound(colours.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, colours.data(), colours.size(), Z_BEST_SPEED) != Z_OK)
    throw std::runtime_error("zlib cannot compress a picture");
  packed.resize(size);
  return packed;
}

}  // namespace

std::string kitty_picture(const TerminalPicture& picture, const Room& room, bool in_place) {
  const std::size_t height = picture.height();
  const std::size_t width_of_rows = room.rows * room.cell_height * 2 * kPixelsARow / height / room.cell_width;
  const std::size_t columns = std::max<std::size_t>(1, std::min(room.columns, width_of_rows));
  const std::size_t rows =
      std::max<std::size_t>(1, columns * room.cell_width * height / (2 * kPixelsARow) / room.cell_height);
  // Show at once: red, green and blue, packed by zlib. The terminal does not answer.
  std::string keys = "a=T,f=24,o=z,q=2,s=" + std::to_string(kPixelsARow) + ",v=" + std::to_string(height) +
                     ",c=" + std::to_string(columns) + ",r=" + std::to_string(rows);
  if (in_place) keys.append(",i=1,p=1,C=1");
  const std::string data = client::to_base64(packed_colours(picture));
  std::string text;
  for (std::size_t at = 0; at < data.size(); at += kMaxCharacters) {
    const bool more = at + kMaxCharacters < data.size();
    text.append("\x1b_G").append(keys).append(keys.empty() ? "m=" : ",m=").append(more ? "1;" : "0;");
    text.append(data, at, kMaxCharacters).append("\x1b\\");
    keys.clear();
  }
  return text;
}

}  // namespace racebeam

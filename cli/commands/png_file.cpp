#include "cli/commands/png_file.hpp"

#include <png.h>

#include <stdexcept>
#include <vector>

namespace racebeam {
namespace {

constexpr std::size_t kPngWidth = 160, kChannels = 3;

std::vector<std::uint8_t> doubled(std::span<const std::uint8_t> rgb) {
  std::vector<std::uint8_t> wide;
  wide.reserve(rgb.size() * 2);
  for (std::size_t at = 0; at < rgb.size(); at += kChannels) {
    const auto pixel = rgb.subspan(at, kChannels);
    for (int copy = 0; copy < 2; ++copy) wide.insert(wide.end(), pixel.begin(), pixel.end());
  }
  return wide;
}

}  // namespace

void write_png(const std::string& path, std::span<const std::uint8_t> rgb) {
  const auto wide = doubled(rgb);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 2 * kPngWidth;
  image.height = static_cast<png_uint_32>(rgb.size() / (kPngWidth * kChannels));
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, path.c_str(), 0, wide.data(), 0, nullptr) == 0) {
    throw std::runtime_error("can't write '" + path + "': " + image.message);
  }
}

}  // namespace racebeam

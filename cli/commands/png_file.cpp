#include "cli/commands/png_file.hpp"

#include <png.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "recording/atomic_file.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kChannels = 3;

std::vector<std::uint8_t> doubled(std::span<const std::uint8_t> rgb) {
  std::vector<std::uint8_t> wide;
  wide.reserve(rgb.size() * 2);
  for (std::size_t at = 0; at < rgb.size(); at += kChannels) {
    const auto pixel = rgb.subspan(at, kChannels);
    for (int copy = 0; copy < 2; ++copy) wide.insert(wide.end(), pixel.begin(), pixel.end());
  }
  return wide;
}

std::vector<std::uint8_t> encoded(std::span<const std::uint8_t> rgb, std::size_t width,
                                  const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(rgb.size() / (width * kChannels));
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::uint8_t> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error("cannot write '" + path + "': " + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

void write_png(const std::string& path, std::span<const std::uint8_t> rgb, std::size_t width) {
  write_picture_file(path, encoded(rgb, width, path));
}

void write_screen(const std::string& path, std::span<const std::uint8_t> rgb) {
  constexpr std::size_t kDoubledWidth = 2 * 160;
  write_png(path, doubled(rgb), kDoubledWidth);
}

// A device or a pipe is written to; another file could not replace it.
void write_picture_file(const std::string& path, std::span<const std::uint8_t> picture) {
  const std::string_view bytes(reinterpret_cast<const char*>(picture.data()), picture.size());
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none)) {
    if (std::ofstream(path, std::ios::binary) << bytes << std::flush) return;
    throw std::runtime_error("cannot write '" + path + "'");
  }
  replace_file(path, bytes, Durable::kLater);
}

}  // namespace racebeam

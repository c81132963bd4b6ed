// A cartridge image: its bytes and how it is called.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "games/md5.hpp"

namespace racebeam {

constexpr std::size_t kMaxImageSize = 524288;

struct Image {
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
  std::string md5;   // of the bytes, lower-case hex
  std::string stem;  // the file's name without its ending, lower case; or the built-in's name
};

// `where`: a path (gzip is inflated), or builtin:NAME. Throws InvalidInput with a sentence.
std::shared_ptr<const Image> load_image(const std::string& where);

// Bytes that came another way. `stem` is what to call them. Throws InvalidInput when there are none or
// too many.
std::shared_ptr<const Image> make_image(std::vector<std::uint8_t> bytes, const std::string& stem);

// The files of a folder that look like images: .bin, .a26 or .rom, also with .gz after it; sorted. Throws
// InvalidInput when the folder can't be listed.
std::vector<std::string> image_files(const std::string& folder);

// The images that are part of the program.
struct BuiltInImage {
  std::string_view name;
  std::span<const std::uint8_t> bytes;
};
std::span<const BuiltInImage> builtin_images();

}  // namespace racebeam

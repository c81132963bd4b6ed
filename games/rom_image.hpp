// A cartridge image: its bytes, and its name.
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
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;  // those of a smaller cartridge fill 2K
  std::string md5;                                         // of the file's bytes, in lower-case hex
  std::string stem;           // the file's name without its extension, in lower case; or the built-in's name
  std::size_t file_size = 0;  // of a smaller cartridge, whose file is the end of `bytes`; 0: all are the file

  std::span<const std::uint8_t> file() const {
    return file_size == 0 ? std::span(*bytes) : std::span(*bytes).last(file_size);
  }
};

// `where`: a path (gzip is inflated, a zip archive must have one image), or builtin:NAME. Throws InvalidInput
// with a sentence.
std::shared_ptr<const Image> load_image(const std::string& where);

// The image in the contents of a file, which load_image() reads like this. Throws InvalidInput with a
// sentence.
std::shared_ptr<const Image> image_in_file(std::string_view file, const std::string& name);

// Makes an image of bytes. `stem` is its name. Throws InvalidInput if `bytes` is empty or too long.
std::shared_ptr<const Image> make_image(std::vector<std::uint8_t> bytes, const std::string& stem);

// The files of a folder that look like images, sorted: .bin, .a26 or .rom, optionally followed by .gz, and
// archives: .zip or .7z. Throws InvalidInput if the folder cannot be listed.
std::vector<std::string> image_files(const std::string& folder);

// The links of a folder that look like images, and lead to no file, sorted. Throws like image_files().
std::vector<std::string> broken_image_links(const std::string& folder);

// An image that is part of the program.
struct BuiltInImage {
  std::string_view name;
  std::span<const std::uint8_t> bytes;
};
std::span<const BuiltInImage> builtin_images();

}  // namespace racebeam

// A cartridge image: the bytes of a game, and the name and MD5 by which it is recognised. An Image never
// changes and its copies share the bytes, so any number of threads may use one.
//
//     const auto image = racebeam::Image::load("builtin:beamfall");  // or a path: "roms/pong.bin"
//     std::cout << image.name() << ' ' << image.md5() << '\n';
//
//     const std::vector<std::uint8_t> bytes(image.bytes().begin(), image.bytes().end());
//     return racebeam::Image::from_bytes(bytes, "beamfall").md5() == image.md5() ? 0 : 1;
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "racebeam/config.hpp"

namespace RACEBEAM_NAMESPACE {

class RACEBEAM_API Image {
 public:
  // Reads a file, or an image that is part of the library: `where` is a path, or "builtin:" and one of
  // built_in(). A file in gzip's format is inflated; a zip archive must contain one image. Throws Error if
  // the file cannot be read, or is not an image.
  static Image load(const std::string& where);

  // Makes an image of a copy of `bytes`. name: the name that a file of them would have, without its
  // extension. Throws Error if `bytes` is empty or has more than 512 KiB.
  static Image from_bytes(std::span<const std::uint8_t> bytes, const std::string& name);

  static std::vector<std::string> built_in();  // the names that load() takes after "builtin:"

  const std::string& name() const noexcept;  // in lower case, without folders and extension
  const std::string& md5() const noexcept;   // of bytes(), in lower-case hex
  std::span<const std::uint8_t> bytes() const noexcept;

 private:
  friend struct Internals;
  struct Impl;
  explicit Image(std::shared_ptr<const Impl> impl);

  std::shared_ptr<const Impl> impl_;
};

}  // namespace RACEBEAM_NAMESPACE

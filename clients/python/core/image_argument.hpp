// An image as Python gives it: a path, "builtin:NAME", or its bytes.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/variant.h>

#include <filesystem>
#include <memory>
#include <string>
#include <variant>

#include "games/rom_image.hpp"

namespace racebeam::python {

using ImageArgument = std::variant<nanobind::bytes, std::filesystem::path>;

// Throws InvalidInput. `stem` is the name of an image that is given as bytes. Bytes are read without the GIL,
// since nothing changes them.
inline std::shared_ptr<const Image> image_of(const ImageArgument& where, const std::string& stem) {
  if (const auto* const path = std::get_if<std::filesystem::path>(&where)) return load_image(path->string());
  const auto& bytes = std::get<nanobind::bytes>(where);
  const auto* const begin = static_cast<const std::uint8_t*>(bytes.data());
  return make_image({begin, begin + bytes.size()}, stem);
}

}  // namespace racebeam::python

// Images for test cases. If an image is missing, these report that something is left out, and return null.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "tests/support/roms.hpp"
#include "tests/support/skip.hpp"

namespace racebeam::test {

// Finds an image by the beginning of its MD5.
inline std::shared_ptr<const Image> needed_rom(const std::string& name, std::string_view md5) {
  auto image = find_rom(md5);
  if (!image) leave_out("no image of " + name + " (MD5 " + std::string(md5) + ") in RACEBEAM_ROMS or .venv");
  return image;
}

// Finds the image of a game of the catalogue.
inline std::shared_ptr<const Image> needed_rom_of(const std::string& game) {
  auto image = find_rom_of(*find_game(game));
  if (!image) leave_out("no image of " + game + " in RACEBEAM_ROMS or .venv");
  return image;
}

}  // namespace racebeam::test

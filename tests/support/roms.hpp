// Cartridge images that are not part of the tree: from the folder RACEBEAM_ROMS, else from an ale-py in a
// virtual environment `.venv` at the root of the repository.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

// The folder of images; empty if none was found.
std::string rom_folder();

// Finds an image by the beginning of its MD5. Returns null if the folder lacks it.
std::shared_ptr<const Image> find_rom(std::string_view md5);

// Finds the image of a game of the catalogue.
std::shared_ptr<const Image> find_rom_of(const Game& game);

}  // namespace racebeam::test

// Cartridge images that are not ours to ship: taken from the folder named by RACEBEAM_ROMS, or else from an
// ale-py installed in a virtual environment `.venv` at the root of the repository.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"

namespace racebeam::test {

// Empty if there is none.
std::string rom_folder();

// By the beginning of its MD5; null if it isn't in the folder.
std::shared_ptr<const Image> find_rom(std::string_view md5);

// The same for a game of the catalogue.
std::shared_ptr<const Image> find_rom_of(const Game& game);

}  // namespace racebeam::test

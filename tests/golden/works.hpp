// The work of the golden digests and of the signature. It only needs our own cartridge images.
#pragma once

#include <vector>

#include "tests/golden/work.hpp"

namespace racebeam::test {

// A game of our own, under several settings.
std::vector<Work> works_of(const std::string& game);

// Random programs, in every scheme and television standard, with joysticks and with paddles. Also the program
// that tests the CPU (tests/emulator/cpu/functional.asm).
std::vector<Work> works_of_programs();

// Every game with an image (tests/support/roms.hpp) except our own, in its first mode and its last. frames:
// of each of the two; 0: as many as 150 acts have.
std::vector<Work> works_of_images(int frames = 0);

}  // namespace racebeam::test

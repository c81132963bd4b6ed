// What is played for the golden digests, and for the signature. No cartridge image is needed that is not
// ours.
#pragma once

#include <vector>

#include "tests/golden/work.hpp"

namespace racebeam::test {

// A game of our own, under several settings.
std::vector<Work> works_of(const std::string& game);

// Random programs, in every scheme and television standard, with sticks and with paddles; and the program
// that checks the processor (tests/emulator/cpu/functional.asm).
std::vector<Work> works_of_programs();

// Every game whose image is here (tests/support/roms.hpp), in its first mode and its last; our own are not among them.
std::vector<Work> works_of_images();

}  // namespace racebeam::test

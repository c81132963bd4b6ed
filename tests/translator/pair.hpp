// One image on two machines: the interpreter's and the translator's.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/translator/translator.hpp"

namespace racebeam {
class Console;
}

namespace racebeam::test {

// What differs between two machines: state, cartridge RAM, pictures, sound. Empty if nothing does. It makes a block of
// sound on both.
std::string difference(Console& interpreted, Console& translated);

// Runs the program of a seed on the interpreter and on `cpu`, `steps` steps, with states saved and restored on the way, and compares
// everything after each: state, cartridge RAM, pictures, sound. Empty if all is the same, else what differs.
std::string difference_in_program(std::uint32_t seed, int steps, CpuKind cpu = CpuKind::kTranslator);

}  // namespace racebeam::test

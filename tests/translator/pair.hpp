// One image on two machines, interpreted and translated.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/translator/translator.hpp"
#include "tests/translator/random_program.hpp"

namespace racebeam {
class Console;
}

namespace racebeam::test {

// The difference between two machines: state, cartridge RAM, pictures, sound. Empty if they are equal. Makes
// a block of sound on both.
std::string difference(Console& interpreted, Console& translated);

// Runs the program that `make` makes of a seed on the interpreter and on `cpu` for `steps` steps, and saves
// and restores states on the way. Compares state, cartridge RAM, pictures and sound after each step. Returns
// the first difference; empty if they are equal.
std::string difference_in_program(std::uint32_t seed, int steps, CpuKind cpu = CpuKind::kTranslator,
                                  Program (*make)(std::uint32_t) = make_program);

}  // namespace racebeam::test

// Proves that a program overwrites everything that a system reset leaves to chance before it reads it. Then a
// reset leads to the same state, whatever the random contents were (reset_cache.hpp).
#pragma once

#include "emulator/console.hpp"

namespace racebeam {

struct BootFacts {
  bool clears_ram = false;  // all 128 bytes
  bool sets_timer = false;
  bool sets_sound = false;  // all six registers
};

// Follows the program of a console that was just reset, without running it. The analysis continues while
// everything that the program reads is known: its own bytes, and RAM that it has written. It stops, with what
// is proven so far, at the first read of anything else, at an unknown instruction, and near a cartridge's hot
// spots. `scheme` is the cartridge's; nothing is proven for schemes that do not show plain memory.
BootFacts analyze_boot(const Console& console, std::string_view scheme);

}  // namespace racebeam

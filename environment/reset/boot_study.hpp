// What a program does first: does it overwrite all that a system reset leaves to chance before it looks at any of
// it? Then a reset leads to the same state whatever that was (reset_cache.hpp).
#pragma once

#include "emulator/console.hpp"

namespace racebeam {

struct BootFacts {
  bool clears_ram = false;  // all 128 bytes
  bool sets_timer = false;
  bool sets_sound = false;  // all six registers
};

// Follows the program of a console that was just reset, without running it, for as long as everything that it
// reads is known: its own bytes, and RAM that it has written. Stops, with what is proven by then, at the first read
// of anything else, at an instruction that it does not know, and near a cartridge's hot spots. `scheme` is the
// cartridge's; nothing is proven of those that do not show plain memory.
BootFacts study_boot(const Console& console, std::string_view scheme);

}  // namespace racebeam

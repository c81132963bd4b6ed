#pragma once

#include <cstdint>

#include "emulator/memory_map.hpp"

namespace racebeam::translator {

// What the code of a window is translated for: constant as long as it is valid.
struct Window {
  CodeWindow code;                 // in the translator's own copy of the image
  std::uint64_t plain_registers;   // of the TIA: writes that only go to the log
  const void* const* entries;      // by offset in the window: where the blocks start, null where there is none

  bool cartridge_watches() const { return plain_registers == 0; }  // accesses to the TIA
};

}  // namespace racebeam::translator

#pragma once

#include <cstdint>

#include "emulator/memory_map.hpp"

namespace racebeam::translator {

// What all boards with the same cartridge scheme have in common.
struct Wiring {
  std::uint64_t plain_registers;  // of the TIA: writes that only go to the log
  unsigned quiet_ports;           // of the scheme

  bool operator==(const Wiring&) const = default;
  bool cartridge_watches() const { return plain_registers == 0; }  // accesses to the TIA
  bool is_quiet_port(std::uint16_t address) const { return (address & 0x1000) != 0 && (address & 0x0FFFU) < quiet_ports; }
};

// What the code of a window is translated for: constant as long as it is valid.
struct Window : Wiring {
  CodeWindow code;                 // in the translator's own copy of the image
  const void* const* entries;      // by offset in the window: where the blocks start, null where there is none
};

}  // namespace racebeam::translator

#pragma once

#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/memory_map.hpp"

namespace racebeam::translator {

// What all boards with the same cartridge scheme have in common.
struct Wiring {
  std::uint64_t plain_registers;  // of the TIA: writes that only go to the log
  PortReader (*port_reader_at)(std::uint16_t address);  // of the scheme

  bool operator==(const Wiring&) const = default;
  bool cartridge_watches() const { return plain_registers == 0; }  // accesses to the TIA

  // What reads a port of the cartridge that selects no bank; null if there is none at `address`.
  PortReader port_reader(std::uint16_t address) const {
    return (address & 0x1000) != 0 && port_reader_at != nullptr ? port_reader_at(address) : nullptr;
  }
};

// What the code of a window is translated for: constant as long as it is valid.
struct Window : Wiring {
  CodeWindow code;                 // in the translator's own copy of the image
  const void* const* entries;      // by offset in the window: where the blocks start, null where there is none
};

}  // namespace racebeam::translator

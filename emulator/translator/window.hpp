#pragma once

#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/memory_map.hpp"

namespace racebeam::translator {

// How the cartridge is wired: the same for all boards with one cartridge scheme.
struct Wiring {
  std::uint64_t plain_registers;  // TIA registers whose writes only go to the write log, a bit each
  PortReader (*port_reader_at)(std::uint16_t address);  // the scheme's function, or null

  bool operator==(const Wiring&) const = default;
  bool cartridge_watches() const { return plain_registers == 0; }  // it reacts to accesses to the TIA

  // Returns the function that reads the cartridge's port at `address` without selecting a bank; null if such
  // a port is not there.
  PortReader port_reader(std::uint16_t address) const {
    return (address & 0x1000) != 0 && port_reader_at != nullptr ? port_reader_at(address) : nullptr;
  }
};

// What the translation of a window's code depends on. It is constant while that code is valid.
struct Window : Wiring {
  const std::uint8_t* image;   // the translator's own copy
  CodeWindow code;             // the window in that copy
  const void* const* entries;  // by offset in the window: the start of a block, or null

  // Whether the window contains the byte at an address.
  bool covers(std::uint16_t address) const { return offset_of(address) < size(); }
  bool covers(std::uint16_t first, unsigned count) const { return offset_of(first) + count <= size(); }
  std::uint8_t byte_at(std::uint16_t address) const { return code.memory[offset_of(address)]; }
  unsigned offset_of(std::uint16_t address) const {
    // Bits 15 and 14 are not decoded, so that addresses repeat.
    return static_cast<std::uint16_t>((address & 0x3FFF) - (code.first & 0x3FFF));
  }
  unsigned size() const { return code.span + 2U; }
};

}  // namespace racebeam::translator

// What a cartridge scheme is: one record. A cartridge shows plain memory to the CPU through the memory map and acts
// only where its pages are hidden: hot spots and write ports (spec: cartridges.md).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "emulator/memory_map.hpp"
#include "emulator/state.hpp"

namespace racebeam {

using Rom = std::vector<std::uint8_t>;

struct Scheme;

// A cartridge at work: its image, its part of the machine's state, and what the CPU sees of it.
struct Slot {
  const Rom& rom;
  const Scheme& scheme;
  CartridgeState& state;
  MemoryMap& map;
};

struct Scheme {
  std::string_view name;
  unsigned hotspot;              // Atari's family: offset in 4K of the first hot spot, number of banks, initial bank
  std::uint8_t banks, initial;
  unsigned ram;                  // bytes on the cartridge, filled at every reset
  bool owns_low_page;            // takes part in accesses to $0000-$003F

  void (*reset)(Slot&);                                 // initial banks
  void (*map)(Slot&);                                   // shows what the banks select
  std::uint8_t (*read)(Slot&, std::uint16_t address);   // of a hidden page
  void (*write)(Slot&, std::uint16_t address, std::uint8_t value);  // of any cartridge address, or the low page
};

// The scheme of an image by its size and signatures; throws std::invalid_argument when none fits, or the one that
// does is not built.
const Scheme& detect_scheme(const Rom& rom);

// The name alone, built or not; empty when none fits.
std::string_view scheme_name(const Rom& rom);

}  // namespace racebeam

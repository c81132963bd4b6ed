// Activision's FE: two banks of 4K, without a hot spot. Bit 13 of the CPU's address selects one: code at
// $F000 sees the first half of the image, and code at $D000 the second.
#pragma once

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::activision {

inline void reset(CartridgeSlot&) {}

inline void map(CartridgeSlot& slot) {
  for (unsigned offset = 0; offset < 4096; offset += MemoryMap::kPageSize) {
    slot.map.page[(0x3000 + offset) >> 6] = slot.rom.data() + offset;
    slot.map.page[(0x1000 + offset) >> 6] = slot.rom.data() + 4096 + offset;
  }
}

}  // namespace racebeam::activision

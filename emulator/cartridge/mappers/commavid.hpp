// CommaVid's CV. 2K of ROM at $1800, 1K of RAM read at $1000-$13FF and written at $1400-$17FF; the write port
// reads as ROM. An image of 4K has the RAM's first contents before the ROM (in MagiCard, a saved program).
#pragma once

#include <algorithm>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::commavid {

constexpr unsigned kRomSize = 2048, kRamSize = 1024;

inline void reset_empty(CartridgeSlot&) {}

inline void reset_filled(CartridgeSlot& slot) { std::copy_n(slot.rom.begin(), kRamSize, slot.ram.begin()); }

inline void map(CartridgeSlot& slot) {
  const std::uint8_t* rom = slot.rom.data() + slot.scheme.least_image - kRomSize;
  slot.map.show(0, slot.ram.data(), kRamSize);
  slot.map.show(kRamSize, rom + kRamSize, kRamSize);
  slot.map.show(2 * kRamSize, rom, kRomSize);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if ((address & 0xC00) == kRamSize) slot.ram[address & (kRamSize - 1)] = value;
  return Delivery::kTaken;
}

}  // namespace racebeam::commavid

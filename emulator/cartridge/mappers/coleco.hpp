// Coleco's JANE (Tarzan). Four banks of 4K, selected by an access to $1FF0, $1FF1, $1FF8 or $1FF9.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::coleco {

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFF6U) != slot.scheme.hotspot) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((address >> 2 & 2) + (address & 1));
  atari::map(slot);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  return atari::bank(slot)[address & 0xFFF];
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  touch(slot, address);
  return Delivery::kTaken;
}

}  // namespace racebeam::coleco

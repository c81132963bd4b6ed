// Dynacom's MB (Megaboy). Sixteen banks of 4K; each access to $1FF0 selects the next one.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::dynacom {

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFFF) != slot.scheme.hotspot) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((slot.state.bank[0] + 1U) % slot.scheme.banks);
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

}  // namespace racebeam::dynacom

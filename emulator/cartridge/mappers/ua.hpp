// UA Ltd.'s UA. Two banks of 4K, selected by an access to $0220 or $0240. These are addresses of the TIA,
// which is accessed too.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::ua {

inline void map(CartridgeSlot& slot) { slot.map.show(0, atari::bank(slot), atari::kBankSize); }

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned place = address & 0x1FFF;
  if (place != 0x220 && place != 0x240) return;
  slot.state.bank[0] = place == 0x240;
  map(slot);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  return 0;
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  touch(slot, address);
  return address & 0x1000 ? Delivery::kTaken : Delivery::kToTia;
}

}  // namespace racebeam::ua

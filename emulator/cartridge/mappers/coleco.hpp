// Coleco's JANE (Tarzan). Four banks of 4K, selected by an access to $1FF0, $1FF1, $1FF8 or $1FF9.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::coleco {

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFF6U) != slot.scheme.hotspot) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((address >> 2 & 2) + (address & 1));
  atari::map(slot);
}

constexpr auto read = atari::read_after<touch>;
constexpr auto write = atari::write_after<touch>;

}  // namespace racebeam::coleco

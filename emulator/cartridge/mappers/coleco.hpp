// Coleco's JANE (Tarzan). Four banks of 4K, selected by an access to $1FF0, $1FF1, $1FF8 or $1FF9. WF8, of
// two prototypes, has two, selected by bit 2 of what is written to $1FF8.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::coleco {

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFF6U) != slot.scheme.first_hot_spot) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((address >> 2 & 2) + (address & 1));
  atari::map(slot);
}

constexpr auto read = atari::read_after<touch>;
constexpr auto write = atari::write_after<touch>;

inline void read_only(CartridgeSlot&, std::uint16_t) {}
constexpr auto read_wf8 = atari::read_after<read_only>;

inline Delivery write_wf8(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if ((address & 0xFFFU) == slot.scheme.first_hot_spot) {
    slot.state.bank[0] = value >> 2 & 1;
    atari::map(slot);
  }
  return Delivery::kTaken;
}

}  // namespace racebeam::coleco

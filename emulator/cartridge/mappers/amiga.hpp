// Amiga's FC ("Power Play"). Banks of 4K. The number of the next one is written to $1FF8 (bits 0 and 1) and
// $1FF9 (the others), and an access to $1FFC selects it.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::amiga {

using atari::image_banks;

constexpr unsigned kLow = 0xFF8, kHigh = 0xFF9, kSwitch = 0xFFC;
constexpr unsigned kNext = 1;  // index of the next bank among the state's banks

inline void reset(CartridgeSlot& slot) { slot.state.bank = {}; }

inline void map(CartridgeSlot& slot) {
  constexpr unsigned kQuiet = kLow % MemoryMap::kPageSize;
  slot.map.show(0, atari::bank(slot), atari::kBankSize);
  slot.map.hide(kLow - kQuiet, MemoryMap::kPageSize, kQuiet);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  return state.bank[0] < image_banks(slot) && state.bank[kNext] < image_banks(slot) && banks_unused(state, 2);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFFF) != kSwitch) return;
  slot.state.bank[0] = slot.state.bank[kNext];
  map(slot);
}

constexpr auto read = atari::read_after<touch>;

// A value written to kHigh is the upper part of the bank's number. If the image has no such bank, the value
// replaces the whole number.
inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned offset = address & 0xFFF;
  unsigned next = slot.state.bank[kNext];
  if (offset == kLow) next = value & 3U;
  if (offset == kHigh) next = value * 4U < image_banks(slot) ? next % 4 + value * 4U : value;
  slot.state.bank[kNext] = static_cast<std::uint8_t>(next % image_banks(slot));
  touch(slot, address);
  return Delivery::kTaken;
}

}  // namespace racebeam::amiga

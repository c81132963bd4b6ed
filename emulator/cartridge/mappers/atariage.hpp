// X07, of Stella's Stocking: 16 banks of 4K. An access to $080D, $081D to $08FD selects one; mirrors of these
// addresses in the lower 4K do, too. In the last two banks, an access to the TIA selects one of these two:
// bit 6 of its address is the bank's.
#pragma once

#include "emulator/cartridge/mappers/ua.hpp"

namespace racebeam::atariage {

constexpr unsigned kSelecting = 0x180F, kSelects = 0x080D;     // 0 1xxx nnnn 1101
constexpr unsigned kTiaSelecting = 0x1880, kFirstOfPair = 14;  // 0 0xxx 0nxx xxxx

inline void select(CartridgeSlot& slot, unsigned bank) {
  if (bank == slot.state.bank[0]) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(bank);
  ua::map(slot);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & kSelecting) == kSelects)
    select(slot, address >> 4 & 0xFU);
  else if ((address & kTiaSelecting) == 0 && slot.state.bank[0] >= kFirstOfPair)
    select(slot, kFirstOfPair | (address >> 6 & 1U));
}

}  // namespace racebeam::atariage

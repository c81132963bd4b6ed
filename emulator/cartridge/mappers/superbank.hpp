// SB, "SuperBank": up to 64 banks of 4K. An access to $0800-$083F, which are the TIA's addresses, too,
// selects one. It starts with the last.
//
// MDM, of menus for many games: an access to $0800-$0FFF selects one of up to 128 banks, by the lower 7 bits
// of the address. If bit 7 is set, that one stays until a reset. It starts with the first.
#pragma once

#include "emulator/cartridge/mappers/ua.hpp"

namespace racebeam::superbank {

using atari::image_banks;

inline void reset(CartridgeSlot& slot) {
  slot.state.bank[0] = static_cast<std::uint8_t>(image_banks(slot) - 1);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  return state.bank[0] < image_banks(slot) && banks_unused(state, 1);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0x1FC0) != 0x0800) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((address & 0x3FU) % image_banks(slot));
  ua::map(slot);
}

constexpr unsigned kLocked = 1;  // index among the state's banks: whether the bank stays

inline void reset_mdm(CartridgeSlot& slot) { slot.state.bank = {}; }

inline bool admits_mdm(const CartridgeSlot& slot, const CartridgeState& state) {
  return state.bank[0] < image_banks(slot) && state.bank[kLocked] <= 1 && banks_unused(state, 2);
}

inline void touch_mdm(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0x1800) != 0x0800 || slot.state.bank[kLocked] != 0) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((address & 0x7FU) % image_banks(slot));
  slot.state.bank[kLocked] = address >> 7 & 1;
  ua::map(slot);
}

}  // namespace racebeam::superbank

// SB, "SuperBank": up to 64 banks of 4K. An access to $0800-$083F, which are the TIA's addresses, too,
// selects one. It starts with the last.
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

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  return 0;
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  touch(slot, address);
  return address & 0x1000 ? Delivery::kTaken : Delivery::kToTia;
}

}  // namespace racebeam::superbank

// Parker Brothers' E0. Eight slices of 1K, seen through four windows. An access to $1FE0-$1FE7 selects the
// slice of the window at $1000, to $1FE8-$1FEF that at $1400, to $1FF0-$1FF7 that at $1800. The window at
// $1C00 always shows slice 7. 03E0, of clones from Brazil, has its hot spots at $0380-$03FF, which are the
// RIOT's addresses: the bits 4, 5 and 6 select the windows by 0, and the bits 0 to 2 are the slice.
#pragma once

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::parker {

constexpr unsigned kSlice = 1024;
constexpr unsigned kFirstHotspot = 0xFE0, kHotPage = 4 * kSlice - MemoryMap::kPageSize;

inline const std::uint8_t* slice(const CartridgeSlot& slot, unsigned window) {
  return slot.rom.data() + kSlice * slot.state.bank[window];
}

inline void reset(CartridgeSlot& slot) {
  for (unsigned window = 0; window < 4; ++window)
    slot.state.bank[window] = static_cast<std::uint8_t>(4 + window);
}

inline void map_03e0(CartridgeSlot& slot) {
  for (unsigned window = 0; window < 4; ++window) slot.map.show(kSlice * window, slice(slot, window), kSlice);
}

inline void map(CartridgeSlot& slot) {
  map_03e0(slot);
  slot.map.hide(kHotPage, MemoryMap::kPageSize, kFirstHotspot - kHotPage);
}

inline void select(CartridgeSlot& slot, unsigned window, unsigned number) {
  slot.state.bank[window] = static_cast<std::uint8_t>(number);
  slot.map.show(kSlice * window, slice(slot, window), kSlice);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned hotspot = (address & 0xFFFU) - kFirstHotspot;
  if (hotspot < 24) select(slot, hotspot / 8, hotspot % 8);
}

inline void touch_03e0(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0x1F80) != 0x0380) return;
  for (unsigned window = 0; window < 3; ++window)
    if ((address & 0x10U << window) == 0) select(slot, window, address & 7U);
}

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  const auto& bank = state.bank;
  return bank[0] < 8 && bank[1] < 8 && bank[2] < 8 && bank[3] == 7 && banks_unused(state, 4);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  return slice(slot, 3)[address & (kSlice - 1)];
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  touch(slot, address);
  return Delivery::kTaken;
}

}  // namespace racebeam::parker

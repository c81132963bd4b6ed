// M Network's E7. $1000-$17FF shows one of eight slices of 2K: $1FE0-$1FE6 select slices 0 to 6. $1FE7
// selects 1K of RAM instead, written at $1000-$13FF and read at $1400-$17FF. Above are 256 more bytes of RAM,
// one of four banks selected by $1FE8-$1FEB, written at $1800 and read at $1900. The rest is slice 7. Write
// ports read as slice 7. Smaller images, of four or six slices, are those up to slice 7.
#pragma once

#include <algorithm>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::mnetwork {

constexpr unsigned kSlice = 2048, kLastSlice = 7, kSlices = kLastSlice + 1;
constexpr unsigned kLowRam = 1024, kHighRam = 256, kHighRamBanks = 4;

// In place of a missing slice, the image's first ones are visible.
inline const std::uint8_t* slice(const CartridgeSlot& slot, unsigned number) {
  const unsigned missing = kSlices - std::min(kSlices, static_cast<unsigned>(slot.rom.size()) / kSlice);
  return slot.rom.data() + kSlice * (number < missing ? number : number - missing);
}

inline bool low_ram_shows(const CartridgeSlot& slot) { return slot.state.bank[0] == kLastSlice; }

inline std::uint8_t* high_ram(const CartridgeSlot& slot) {
  return slot.ram.data() + kLowRam + kHighRam * slot.state.bank[1];
}

inline void reset(CartridgeSlot& slot) { slot.state.bank = {}; }

inline void map(CartridgeSlot& slot) {
  slot.map.show(0, slice(slot, slot.state.bank[0]), kSlice);
  if (low_ram_shows(slot)) slot.map.show(kLowRam, slot.ram.data(), kLowRam);
  slot.map.show(kSlice, slice(slot, kLastSlice), kSlice - MemoryMap::kPageSize);
  slot.map.show(kSlice + kHighRam, high_ram(slot), kHighRam);
  slot.map.hide(2 * kSlice - MemoryMap::kPageSize, MemoryMap::kPageSize);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned hotspot = (address & 0xFFFU) - 0xFE0;
  if (hotspot >= 12) return;
  slot.state.bank[hotspot / 8] = hotspot % 8;
  map(slot);
}

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  return state.bank[0] <= kLastSlice && state.bank[1] < kHighRamBanks && banks_unused(state, 2);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  return slice(slot, kLastSlice)[address & (kSlice - 1)];
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  touch(slot, address);
  const unsigned offset = address & 0xFFF;
  if (offset < kLowRam && low_ram_shows(slot)) slot.ram[offset] = value;
  if (offset >= kSlice && offset < kSlice + kHighRam) high_ram(slot)[offset - kSlice] = value;
  return Delivery::kTaken;
}

}  // namespace racebeam::mnetwork

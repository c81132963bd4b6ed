// FA2, of Star Castle: six or seven banks of 4K, selected at $1FF5-$1FFB, and 256 bytes of RAM, written at
// $1000-$10FF and read at $1100-$11FF. An image may have 1K of the board's own code in front. An access to
// $1FF4 would save the RAM in flash memory, or load it. This one has no such memory: the operation ends at
// once, which bit 6 shows, and changes nothing.
#pragma once

#include <algorithm>

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::starcastle {

constexpr unsigned kFlash = 0xFF4;
constexpr std::uint8_t kBusy = 0x40;

inline unsigned banks(const CartridgeSlot& slot) {
  return std::min<unsigned>(slot.scheme.banks, atari::image_banks(slot));
}

inline const std::uint8_t* bank(const CartridgeSlot& slot) {
  const std::size_t own_code = slot.rom.size() % atari::kBankSize;
  return slot.rom.data() + own_code + atari::kBankSize * slot.state.bank[0];
}

inline void reset(CartridgeSlot& slot) { slot.state.bank[0] = 0; }

inline void map(CartridgeSlot& slot) {
  constexpr unsigned kQuiet = kFlash % MemoryMap::kPageSize;
  slot.map.show(0, bank(slot), atari::kBankSize);
  slot.map.show(slot.scheme.ram_bytes, slot.ram.data(), slot.scheme.ram_bytes);
  slot.map.hide(kFlash - kQuiet, MemoryMap::kPageSize, kQuiet);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  return state.bank[0] < banks(slot) && banks_unused(state, 1);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.first_hot_spot;
  if (selected >= banks(slot)) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(selected);
  map(slot);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  const unsigned offset = address & 0xFFF;
  const std::uint8_t byte = bank(slot)[offset];
  return static_cast<std::uint8_t>(offset == kFlash ? byte & ~kBusy : byte);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  touch(slot, address);
  return atari::write_ram(slot, address, value);
}

}  // namespace racebeam::starcastle

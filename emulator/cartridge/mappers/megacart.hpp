// MC, Chris Wilkson's Megacart. Four windows of 1K, each with a block number, which is written to
// $003C-$003F. Numbers from $80 on are blocks of 1K of the 128K of ROM. Lower ones are blocks of 512 bytes of
// the 32K of RAM, written in the lower half of the window and read in the upper. An access to the reset
// vector locks the last block of ROM into the fourth window, until another window is accessed. Reads of
// $0000-$003F give 0; writes to them do not reach the TIA (docs/spec/cartridges.md, 10).
#pragma once

#include <algorithm>
#include <array>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::megacart {

constexpr unsigned kWindows = 4, kWindow = 1024;
constexpr unsigned kRamBlock = 512, kRamBlocks = 64;
constexpr unsigned kRomFlag = 0x80;
constexpr std::uint8_t kLastBlock = 0xFF;
constexpr unsigned kLock = 4;  // index of the lock among the state's banks, after the four windows

inline constexpr std::array<std::uint8_t, MemoryMap::kPageSize> kZeros{};

inline bool locked(const CartridgeSlot& slot) { return slot.state.bank[kLock] != 0; }

inline unsigned block(const CartridgeSlot& slot, unsigned window) {
  return window == kWindows - 1 && locked(slot) ? kLastBlock : slot.state.bank[window];
}

inline const std::uint8_t* rom_block(const CartridgeSlot& slot, unsigned number) {
  return slot.rom.data() + kWindow * (number & ~kRomFlag);
}

inline std::uint8_t& ram_byte(CartridgeSlot& slot, unsigned number, std::uint16_t address) {
  return slot.ram[number % kRamBlocks * kRamBlock + address % kRamBlock];
}

inline void reset(CartridgeSlot&) {}

// While the fourth window is locked, every access to another window unlocks it.
inline void map_window(CartridgeSlot& slot, unsigned window) {
  const unsigned first = kWindow * window, number = block(slot, window);
  slot.map.hide(first, kWindow);
  if (locked(slot) && window != kWindows - 1) return;
  if (number & kRomFlag)
    slot.map.show(first, rom_block(slot, number), kWindow);
  else
    slot.map.show(first + kRamBlock, &ram_byte(slot, number, 0), kRamBlock);
}

inline void map(CartridgeSlot& slot) {
  for (unsigned window = 0; window < kWindows; ++window) map_window(slot, window);
  slot.map.hide(kWindows * kWindow - MemoryMap::kPageSize, MemoryMap::kPageSize);
  slot.map.page[0] = slot.map.page[0x2000 / MemoryMap::kPageSize] = kZeros.data();
}

inline void lock(CartridgeSlot& slot, bool on) {
  if (locked(slot) == on) return;
  slot.state.bank[kLock] = on;
  map(slot);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned place = address & 0x1FFF;
  if (place == 0x1FFC || place == 0x1FFD)
    lock(slot, true);
  else if (place >= 0x1000 && place < 0x1C00)
    lock(slot, false);
}

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  return state.bank[kLock] <= 1 && banks_unused(state, kLock + 1);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  if ((address & 0x1000) == 0) return 0;
  touch(slot, address);
  const unsigned number = block(slot, address >> 10 & 3);
  if (number & kRomFlag) return rom_block(slot, number)[address % kWindow];
  std::uint8_t& byte = ram_byte(slot, number, address);
  if ((address & kRamBlock) == 0) byte = 0;
  return byte;
}

inline void write_ram(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned number = block(slot, address >> 10 & 3);
  if ((number & kRomFlag) == 0 && (address & kRamBlock) == 0) ram_byte(slot, number, address) = value;
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned place = address & 0x1FFF;
  touch(slot, address);
  if (place >= 0x3C && place < 0x40) {
    slot.state.bank[place & 3] = value;
    map(slot);
    return Delivery::kTaken;
  }
  if (place >= 0x40 && place < 0x1000) return Delivery::kToTia;
  write_ram(slot, address, value);
  return Delivery::kTaken;
}

}  // namespace racebeam::megacart

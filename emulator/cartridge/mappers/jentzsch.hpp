// 3E+, of Thomas Jentzsch and Andrew Davie. Four windows of 1K, each of which shows a bank of 1K of ROM, or
// one of 512 bytes of RAM, read in the lower half of the window and written in the upper. A write to $3F
// selects ROM, to $3E RAM: bits 6 and 7 are the window, the others the bank. It starts with bank 0 in all
// windows.
#pragma once

#include <algorithm>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::jentzsch {

constexpr unsigned kWindows = 4, kWindow = 1024;
constexpr unsigned kRamBank = 512, kRamBanks = 64, kMaxRomBanks = 64;
constexpr unsigned kRamFlag = 0x80;  // in the state's banks: the window shows RAM

inline unsigned rom_banks(const CartridgeSlot& slot) {
  return std::min(static_cast<unsigned>(slot.rom.size()) / kWindow, kMaxRomBanks);
}

inline std::uint8_t* ram_bank(const CartridgeSlot& slot, unsigned number) {
  return slot.ram.data() + kRamBank * (number % kRamBanks);
}

inline void reset(CartridgeSlot& slot) { slot.state.bank = {}; }

// The upper half mirrors the lower half.
inline void map_window(CartridgeSlot& slot, unsigned window) {
  const unsigned number = slot.state.bank[window], first = kWindow * window;
  if ((number & kRamFlag) == 0) return slot.map.show(first, slot.rom.data() + kWindow * number, kWindow);
  for (const unsigned half : {0U, kRamBank}) slot.map.show(first + half, ram_bank(slot, number), kRamBank);
}

inline void map(CartridgeSlot& slot) {
  for (unsigned window = 0; window < kWindows; ++window) map_window(slot, window);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  const auto exists = [&](std::uint8_t bank) {
    return bank & kRamFlag ? bank < kRamFlag + kRamBanks : bank < rom_banks(slot);
  };
  return std::all_of(state.bank.begin(), state.bank.begin() + kWindows, exists) &&
         banks_unused(state, kWindows);
}

inline void select(CartridgeSlot& slot, bool ram, std::uint8_t value) {
  const unsigned window = value >> 6, number = value & 0x3F;
  slot.state.bank[window] = static_cast<std::uint8_t>(ram ? kRamFlag | number : number % rom_banks(slot));
  map_window(slot, window);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned place = address & 0x1FFF;
  if (place == 0x3E || place == 0x3F) select(slot, place == 0x3E, value);
  if (place < 0x1000) return Delivery::kToTia;
  const unsigned number = slot.state.bank[place / kWindow % kWindows];
  if ((number & kRamFlag) != 0 && (place & kRamBank) != 0) ram_bank(slot, number)[place % kRamBank] = value;
  return Delivery::kTaken;
}

}  // namespace racebeam::jentzsch

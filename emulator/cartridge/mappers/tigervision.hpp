// Tigervision's 3F. Banks of 2K: the number of the one at $1000 is written to $0000-$003F. The last 2K of the
// image stay at $1800. Reads of $0000-$003F give the bank's bytes, not the TIA's; the TIA's mirrors from
// $0040 on are not affected. Writes to the cartridge reach the TIA too, and $1000-$103F selects like
// $0000-$003F. If the image ends within a bank, that bank can be selected, too.
//
// 3E, of Boulder Dash, also has 32 banks of 1K of RAM. Writes to $3F select ROM, to $3E RAM, and no other
// address selects. RAM is read at $1000 and again at $1400, where it is also written; such a write does not
// reach the TIA. 3EX has 256 banks of RAM.
#pragma once

#include <algorithm>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::tigervision {

constexpr unsigned kBankSize = 2048;
constexpr unsigned kRamBankSize = 1024;

inline unsigned whole_banks(const CartridgeSlot& slot) {
  return static_cast<unsigned>(slot.rom.size()) / kBankSize;
}

// Whether the bank has a byte of the image.
inline bool has_bank(const CartridgeSlot& slot, unsigned bank) { return bank * kBankSize < slot.rom.size(); }

inline std::uint8_t selected_by(const CartridgeSlot& slot, unsigned value) {
  return static_cast<std::uint8_t>(has_bank(slot, value) ? value : value % whole_banks(slot));
}

inline unsigned ram_banks(const CartridgeSlot& slot) { return slot.scheme.ram_bytes / kRamBankSize; }

inline void reset(CartridgeSlot& slot) { slot.state.bank[0] = 0; }

inline void show_low_page(CartridgeSlot& slot, const std::uint8_t* bank) {
  slot.map.page[0] = slot.map.page[0x2000 / MemoryMap::kPageSize] = bank;
}

// Pages that the image does not fill are hidden: read() reads them.
inline void map(CartridgeSlot& slot) {
  const std::size_t begin = std::size_t{kBankSize} * slot.state.bank[0];
  const auto left = static_cast<unsigned>(std::min<std::size_t>(kBankSize, slot.rom.size() - begin));
  const unsigned filled = left - left % MemoryMap::kPageSize;
  const std::uint8_t* bank = slot.rom.data() + begin;
  slot.map.show(0, bank, filled);
  slot.map.hide(filled, kBankSize - filled);
  slot.map.show(kBankSize, slot.rom.data() + slot.rom.size() - kBankSize, kBankSize);
  show_low_page(slot, filled != 0 ? bank : nullptr);
}

// Returns 0 after the end of the image, where the reference reads memory outside the image.
inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  const std::size_t at = std::size_t{kBankSize} * slot.state.bank[0] + (address & (kBankSize - 1));
  return at < slot.rom.size() ? slot.rom[at] : 0;
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  return has_bank(slot, state.bank[0]) && banks_unused(state, 1);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if ((address & 0x0FFF) >= 0x40) return Delivery::kToTia;
  slot.state.bank[0] = selected_by(slot, value);
  map(slot);
  return Delivery::kToTia;
}

// 3E: bank 0 of the state is the ROM's. If bank 2 is not 0, $1000 shows the RAM's bank 1 instead.
inline bool ram_selected(const CartridgeSlot& slot) { return slot.state.bank[2] != 0; }

inline std::uint8_t* ram_bank(const CartridgeSlot& slot) {
  return slot.ram.data() + kRamBankSize * slot.state.bank[1];
}

inline void reset_3e(CartridgeSlot& slot) { slot.state.bank = {}; }

inline void map_3e(CartridgeSlot& slot) {
  map(slot);
  if (!ram_selected(slot)) return;
  for (const unsigned half : {0U, kRamBankSize}) slot.map.show(half, ram_bank(slot), kRamBankSize);
  show_low_page(slot, ram_bank(slot));
}

inline void select_3e(CartridgeSlot& slot, bool ram, std::uint8_t value) {
  if (ram)
    slot.state.bank[1] = static_cast<std::uint8_t>(value % ram_banks(slot));
  else
    slot.state.bank[0] = selected_by(slot, value);
  slot.state.bank[2] = ram;
  map_3e(slot);
}

inline bool admits_3e(const CartridgeSlot& slot, const CartridgeState& state) {
  const auto& bank = state.bank;
  return has_bank(slot, bank[0]) && bank[1] < ram_banks(slot) && bank[2] <= 1 && banks_unused(state, 3);
}

inline Delivery write_3e(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned offset = address & 0x0FFF;
  if (offset == 0x3E || offset == 0x3F) {
    select_3e(slot, offset == 0x3E, value);
  } else if (ram_selected(slot) && (address & 0x1C00) == 0x1400) {
    ram_bank(slot)[address & (kRamBankSize - 1)] = value;
    return Delivery::kTaken;
  }
  return Delivery::kToTia;
}

}  // namespace racebeam::tigervision

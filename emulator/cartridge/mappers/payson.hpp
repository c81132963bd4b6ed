// John Payson's 4A50, of homebrew: 64K of ROM and 32K of RAM. Three windows show either, and the last page of
// ROM is fixed. RAM is read and written at the same addresses. Hot spots are in RAM, in the TIA and in
// mirrors of both; those of the mirrors select only if the byte that the CPU read before was $6x or $7x
// (docs/spec/cartridges.md, 16).
#pragma once

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::payson {

constexpr unsigned kImage = 65536, kRam = 32768, kBlock = 2048, kPage = 256;
constexpr unsigned kMiddleWindow = 0x800, kUpperWindow = 0xE00, kFixedWindow = 0xF00;

// kLower and kMiddle: the number of a block of ROM, or kInRam and that of a block of RAM. kUpper: a page.
enum Bank { kLower, kMiddle, kUpper, kUpperIsRam };
constexpr std::uint8_t kFirstMiddle = 0x10, kInRam = 0x40, kBlocks = 0x10, kMaxRamPage = 0x7F;

inline std::uint8_t* ram_of(CartridgeSlot& slot, unsigned window) {
  const auto& bank = slot.state.bank;
  if (window == kUpper) return bank[kUpperIsRam] ? &slot.ram[kPage * (bank[kUpper] & kMaxRamPage)] : nullptr;
  return bank[window] & kInRam ? &slot.ram[kBlock * (bank[window] - kInRam)] : nullptr;
}

inline const std::uint8_t* memory_of(CartridgeSlot& slot, unsigned window) {
  const std::uint8_t* ram = ram_of(slot, window);
  return ram != nullptr ? ram
                        : slot.rom.data() + (window == kUpper ? kPage : kBlock) * slot.state.bank[window];
}

inline void map(CartridgeSlot& slot) {
  slot.map.show(0, memory_of(slot, kLower), kMiddleWindow);
  slot.map.show(kMiddleWindow, memory_of(slot, kMiddle), kUpperWindow - kMiddleWindow);
  slot.map.show(kUpperWindow, memory_of(slot, kUpper), kPage);
  slot.map.show(kFixedWindow, slot.rom.data() + (kImage - kPage), kPage);
}

inline void reset(CartridgeSlot& slot) { slot.state.bank = {0, kFirstMiddle}; }

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  const auto& bank = state.bank;
  const auto is_block = [](unsigned number, unsigned first) {
    return number - first < kBlocks || number - kInRam < kBlocks;
  };
  return is_block(bank[kLower], 0) && is_block(bank[kMiddle], kFirstMiddle) && bank[kUpperIsRam] <= 1 &&
         banks_unused(state, kUpperIsRam + 1);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned place = address & 0xFFF;
  if (place >= kFixedWindow) return Delivery::kTaken;
  const unsigned window = place >= kUpperWindow ? kUpper : place >= kMiddleWindow ? kMiddle : kLower;
  if (std::uint8_t* ram = ram_of(slot, window)) ram[place % (window == kUpper ? kPage : kBlock)] = value;
  return Delivery::kTaken;
}

inline void select_page(CartridgeState& state, unsigned page, bool in_ram) {
  state.bank[kUpper] = static_cast<std::uint8_t>(page);
  state.bank[kUpperIsRam] = in_ram;
}

// The cartridge has no bit for the half of the ROM: the lower window shows the first one, the middle one the
// second.
inline void select_block(CartridgeState& state, unsigned window, unsigned number, bool in_ram) {
  const unsigned of_rom = window == kMiddle ? kFirstMiddle : 0;
  state.bank[window] = static_cast<std::uint8_t>((in_ram ? kInRam : of_rom) | number % kBlocks);
}

// low: the low byte of an address $7Fxx. It selects a column of a picture. One bank has the even columns, and
// another one the odd columns.
inline void select_column(CartridgeState& state, unsigned low) {
  const unsigned column = (low >> 4 & 7) | (low & 8);
  state.bank[kUpper] = static_cast<std::uint8_t>((state.bank[kUpper] & 0xF0) | column);
}

inline void select_by_address(CartridgeState& state, unsigned page, unsigned low) {
  const bool in_ram = (low & kInRam) != 0;
  const unsigned first_of_middle = in_ram ? kInRam : kFirstMiddle;
  switch (page) {
    case 0x64: state.bank[kLower] ^= 1; break;
    case 0x65: state.bank[kLower] ^= 2; break;
    case 0x68: state.bank[kMiddle] ^= 1; break;
    case 0x69: state.bank[kMiddle] ^= 2; break;
    case 0x6C: select_page(state, low, false); break;
    case 0x6D:
      if (low <= kMaxRamPage) select_page(state, low, true);
      break;
    case 0x6E:
      if ((low & ~unsigned{kInRam}) < kBlocks) select_block(state, kLower, low, in_ram);
      break;
    case 0x6F:
      if (low - first_of_middle < kBlocks) select_block(state, kMiddle, low, in_ram);
      break;
    case 0x7F: select_column(state, low); break;
    default: break;
  }
}

// $00F4-$00FF, and $0074-$007F for writes.
inline void select_by_value(CartridgeState& state, const Access& access) {
  const unsigned place = access.address & 0x1FFFU;
  const bool is_spot = (place >= 0xF4 && place <= 0xFF) || (access.writes && place >= 0x74 && place <= 0x7F);
  if (!is_spot) return;
  if ((place & 0xC) == 8)
    select_block(state, access.value & 0x80 ? kMiddle : kLower, access.value, (access.value & kInRam) != 0);
  else
    select_page(state, access.value, (place & 1) != 0);
}

// Where an index leads to the next page, the CPU first reads at the same place of the page it came from.
inline void observe(CartridgeSlot& slot, const Access& access) {
  const unsigned low = access.address & 0xFF, page = access.address >> 8, before = access.before;
  CartridgeState& state = slot.state;
  const auto banks = state.bank;
  select_by_value(state, access);
  if (page == before || page == before + 1) select_by_address(state, before, low);
  if (page == 0x7F && before == 0x7E && (memory_of(slot, kUpper)[low] & 0xE0) == 0x60)
    select_by_address(state, page, low);
  if (state.bank != banks) map(slot);
}

}  // namespace racebeam::payson

// Atari's own schemes. 2K and 4K: the image, without banks. F8, F6, F4: two, four or eight banks of 4K. An
// access to one of the addresses up to $1FF9 or $1FFB selects a bank. With SC ("super chip"): 128 bytes of
// RAM, written at $1000-$107F and read at $1080-$10FF; the write port reads as ROM. CBS's FA is similar, with
// three banks and 256 bytes of RAM at $1000-$10FF and $1100-$11FF. The homebrew schemes EF, DF and BF have
// 16, 32 or 64 banks, selected from $1FE0, $1FC0 or $1F80 on.
//
// 2IN1 to 128IN1 are cartridges with that many games of 2K or 4K. The power switch of a console selects the
// next one. Here, the scheme's name says which one it is: "32IN1" the first, "32IN1 2" the second.
#pragma once

#include <algorithm>
#include <span>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::atari {

constexpr unsigned kBankSize = 4096;

inline unsigned image_banks(const CartridgeSlot& slot) {
  return static_cast<unsigned>(slot.rom.size()) / kBankSize;
}

inline const std::uint8_t* bank(const CartridgeSlot& slot) {
  return slot.rom.data() + kBankSize * slot.state.bank[0];
}

// Whether a bank ends with vectors. Banks that never start often end with filling.
inline bool has_vectors(const CartridgeSlot& slot, unsigned number) {
  const std::span end = std::span(slot.rom).subspan(kBankSize * (number + 1) - 4, 4);
  const auto filled = [&](std::uint8_t filling) { return std::ranges::count(end, filling) == 4; };
  return !filled(0) && !filled(0xFF);
}

inline void reset_game(CartridgeSlot& slot) { slot.state.bank = {}; }

// The scheme's initial bank, unless only others have vectors.
inline unsigned start_bank(const CartridgeSlot& slot) {
  const unsigned banks = slot.scheme.banks, initial = slot.scheme.initial_bank;
  for (unsigned turn = 0; banks > 1 && turn < banks; ++turn) {
    const unsigned number = (initial + turn) % banks;
    if (has_vectors(slot, number)) return number;
  }
  return initial;
}

inline void reset(CartridgeSlot& slot) { slot.state.bank[0] = static_cast<std::uint8_t>(start_bank(slot)); }

inline void map_plain(CartridgeSlot& slot) {
  const unsigned size = slot.scheme.least_image;  // 2K is visible twice
  for (unsigned offset = 0; offset < kBankSize; offset += size) slot.map.show(offset, slot.rom.data(), size);
  slot.map.show(slot.scheme.ram_bytes, slot.ram.data(), slot.scheme.ram_bytes);
}

// Maps one game of a cartridge with many. A game of 2K is visible twice.
constexpr unsigned kMinGame = 2048, kMaxGame = 4096;

inline void map_game(CartridgeSlot& slot) {
  const unsigned size = slot.rom.size() < kMaxGame * slot.scheme.banks ? kMinGame : kMaxGame;
  const std::uint8_t* const game = slot.rom.data() + size * slot.scheme.initial_bank;
  for (unsigned offset = 0; offset < kBankSize; offset += size) slot.map.show(offset, game, size);
}

// The hot spots are in one page. Where that is not the last page, they begin with it.
inline void map(CartridgeSlot& slot) {
  const unsigned quiet = slot.scheme.first_hot_spot % MemoryMap::kPageSize;
  slot.map.show(0, bank(slot), kBankSize);
  slot.map.show(slot.scheme.ram_bytes, slot.ram.data(), slot.scheme.ram_bytes);
  slot.map.hide(slot.scheme.first_hot_spot - quiet, MemoryMap::kPageSize, quiet);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.first_hot_spot;
  if (selected >= slot.scheme.banks || selected == slot.state.bank[0]) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(selected);
  map(slot);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  return state.bank[0] < slot.scheme.banks && banks_unused(state, 1);
}

// Accesses in a scheme of banks without RAM, in which `select` chooses the bank by the address.
template <void (*select)(CartridgeSlot&, std::uint16_t)>
std::uint8_t read_after(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  select(slot, address);
  return bank(slot)[address & 0xFFF];
}

template <void (*select)(CartridgeSlot&, std::uint16_t)>
Delivery write_after(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  select(slot, address);
  return Delivery::kTaken;
}

constexpr auto read = read_after<touch>;

inline Delivery write_ram(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned offset = address & 0xFFF;
  if (offset < slot.scheme.ram_bytes) slot.ram[offset] = value;
  return Delivery::kTaken;
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  touch(slot, address);
  return write_ram(slot, address, value);
}

inline Delivery ignore_write(CartridgeSlot&, std::uint16_t, std::uint8_t) { return Delivery::kTaken; }

}  // namespace racebeam::atari

// Activision's DPC, the chip of Pitfall II: two banks of 4K, as F8, and eight fetchers that count down through 2K of
// display data. A fetcher has a flag, which a counter between its top and bottom keeps set: a mask for graphics. Three
// of them make music instead, counting at 15750 Hz by themselves. There is a random number too, clocked by accesses.
//
//   $1000-$103F read: function (address >> 3 & 7) of fetcher (address & 7); $1040-$107F written: its registers
//
// (spec: cartridges.md, section 8)
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "emulator/mappers/atari.hpp"

namespace racebeam::dpc {

constexpr unsigned kDisplay = 8192, kDisplaySize = 2048;  // place in the image, size
constexpr unsigned kFetchers = 8, kFirstMusic = 5;
constexpr unsigned kReadPort = 0x40, kPorts = 0x80, kHotPage = 0xFC0;

struct Fetcher {
  std::uint8_t top, bottom, flag, music;
  std::uint16_t counter;  // 11 bits

  std::uint8_t low() const { return static_cast<std::uint8_t>(counter & 0xFF); }
  void set_low(unsigned low) { counter = static_cast<std::uint16_t>((counter & 0x700) | low); }
  void set_high(unsigned high) { counter = static_cast<std::uint16_t>((high & 7) << 8 | low()); }
};

// Kept in the bytes that other schemes have RAM in.
struct Chip {
  double fraction;  // of a music clock, not yet counted
  std::array<Fetcher, kFetchers> fetcher;
  std::uint8_t random, spare[7];
};
static_assert(sizeof(Chip) <= kRamInState && std::is_trivially_copyable_v<Chip>);

inline Chip chip_of(const Slot& slot) {
  Chip chip;
  std::memcpy(&chip, slot.state.ram.data(), sizeof chip);
  return chip;
}

inline void keep(Slot& slot, const Chip& chip) { std::memcpy(slot.state.ram.data(), &chip, sizeof chip); }

// Once: a reset leaves the fetchers alone.
inline void power_on(Slot& slot) {
  Chip chip{};
  chip.random = 1;
  keep(slot, chip);
}

inline void reset(Slot& slot) {
  atari::reset(slot);
  Chip chip = chip_of(slot);
  chip.fraction = 0;
  keep(slot, chip);
}

inline void map(Slot& slot) {
  slot.map.show(kPorts, atari::bank(slot) + kPorts, kHotPage - kPorts);
  slot.map.hide(0, kPorts);
  slot.map.hide(kHotPage, MemoryMap::kPageSize);
}

inline void touch(Slot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.hotspot;
  if (selected >= slot.scheme.banks) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(selected);
  map(slot);
}

inline void clock_random(Chip& chip) {
  const unsigned r = chip.random;
  const unsigned in = ~(r >> 7 ^ r >> 5 ^ r >> 4 ^ r >> 3) & 1;
  chip.random = static_cast<std::uint8_t>(r << 1 | in);
}

// A music fetcher goes round from its top to 0, and is loud from the top down to the bottom.
inline void count_down(Fetcher& fetcher, int clocks) {
  const int period = fetcher.top + 1;
  int low = fetcher.top == 0 ? 0 : fetcher.low() - clocks % period;
  if (low < 0) low += period;
  fetcher.set_low(static_cast<unsigned>(low));
  if (low <= fetcher.bottom) fetcher.flag = 0x00;
  else if (low <= fetcher.top) fetcher.flag = 0xFF;
}

inline void run_music(Slot& slot, Chip& chip, std::int32_t cycle) {
  const auto passed = static_cast<std::int32_t>(static_cast<std::uint32_t>(cycle) - slot.machine.frame.cartridge_clock);
  slot.machine.frame.cartridge_clock = static_cast<std::uint32_t>(cycle);
  const double clocks = 15750.0 * passed / 1193191.66666667 + chip.fraction;
  const int whole = static_cast<int>(clocks);
  chip.fraction = clocks - whole;
  if (whole <= 0) return;
  for (unsigned i = kFirstMusic; i < kFetchers; ++i)
    if (chip.fetcher[i].music) count_down(chip.fetcher[i], whole);
}

// The three voices mixed by resistors.
inline std::uint8_t amplitude(const Chip& chip) {
  static constexpr std::uint8_t kLevels[8] = {0, 4, 5, 9, 6, 10, 11, 15};
  unsigned voices = 0;
  for (unsigned i = kFirstMusic; i < kFetchers; ++i)
    if (chip.fetcher[i].music && chip.fetcher[i].flag) voices |= 1U << (i - kFirstMusic);
  return kLevels[voices];
}

inline std::uint8_t fetch(Slot& slot, Chip& chip, std::uint16_t address, std::int32_t cycle) {
  const unsigned number = address & 7;
  Fetcher& fetcher = chip.fetcher[number];
  if (fetcher.low() == fetcher.top) fetcher.flag = 0xFF;
  else if (fetcher.low() == fetcher.bottom) fetcher.flag = 0x00;

  const std::uint8_t display = slot.rom[kDisplay + kDisplaySize - 1 - fetcher.counter];
  std::uint8_t result = 0;
  switch (address >> 3 & 7) {
    case 0:
      if (number >= 4) run_music(slot, chip, cycle);
      result = number < 4 ? chip.random : amplitude(chip);
      break;
    case 1: result = display; break;
    case 2: result = display & fetcher.flag; break;
    case 7: result = fetcher.flag; break;
    default: break;
  }
  if (!fetcher.music) fetcher.counter = (fetcher.counter - 1) & (kDisplaySize - 1);
  return result;
}

inline void set_register(Chip& chip, std::uint16_t address, std::uint8_t value) {
  const unsigned number = address & 7;
  Fetcher& fetcher = chip.fetcher[number];
  switch (address >> 3 & 7) {
    case 0:
      fetcher.top = value;
      fetcher.flag = 0;
      break;
    case 1: fetcher.bottom = value; break;
    case 2: fetcher.set_low(fetcher.music ? fetcher.top : value); break;
    case 3:
      fetcher.set_high(value);
      if (number >= kFirstMusic) fetcher.music = value >> 4 & 1;
      break;
    case 6: chip.random = 1; break;
    default: break;
  }
}

inline bool admits(const Slot& slot, const CartridgeState& state) {
  Chip chip;
  std::memcpy(&chip, state.ram.data(), sizeof chip);
  for (unsigned i = 0; i < kFetchers; ++i) {
    const Fetcher& fetcher = chip.fetcher[i];
    if (fetcher.counter >= kDisplaySize || (fetcher.flag != 0 && fetcher.flag != 0xFF)) return false;
    if (fetcher.music > (i >= kFirstMusic ? 1 : 0)) return false;
  }
  const bool is_fraction = chip.fraction > -1 && chip.fraction < 1;
  const bool is_filled_up = std::ranges::all_of(chip.spare, [](std::uint8_t byte) { return byte == 0; });
  return atari::admits(slot, state) && is_fraction && is_filled_up;
}

inline std::uint8_t read(Slot& slot, std::uint16_t address, std::int32_t cycle) {
  const unsigned offset = address & 0xFFF;
  touch(slot, address);
  Chip chip = chip_of(slot);
  clock_random(chip);
  const std::uint8_t value = offset < kReadPort ? fetch(slot, chip, address, cycle) : atari::bank(slot)[offset];
  keep(slot, chip);
  return value;
}

inline Delivery write(Slot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned offset = address & 0xFFF;
  touch(slot, address);
  Chip chip = chip_of(slot);
  clock_random(chip);
  if (offset >= kReadPort && offset < kPorts) set_register(chip, address, value);
  keep(slot, chip);
  return Delivery::kTaken;
}

}  // namespace racebeam::dpc

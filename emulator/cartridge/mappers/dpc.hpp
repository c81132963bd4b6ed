// Activision's DPC, the chip of Pitfall II. It has two banks of 4K, as F8, and eight fetchers that count down
// through 2K of display data. A fetcher has a flag, which is set while its counter is between its top and its
// bottom: a mask for graphics. Three of the fetchers can make music instead, counting at 15750 Hz by
// themselves. A random number generator is clocked by accesses.
//
//   $1000-$103F read: function (address >> 3 & 7) of fetcher (address & 7); $1040-$107F written: its
//   registers
//
// (docs/spec/cartridges.md, 8)
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::dpc {

constexpr unsigned kDisplay = 8192, kDisplaySize = 2048;  // offset in the image, size
constexpr unsigned kFetchers = 8, kFirstMusic = 5;
constexpr unsigned kFirstSound = 4;  // from this fetcher on, kRandomOrSound reads the sound
constexpr unsigned kReadPort = 0x40, kPorts = 0x80, kHotPage = 0xFC0;

struct Fetcher {
  std::uint8_t top, bottom, flag, music;
  std::uint16_t counter;  // 11 bits

  std::uint8_t low() const { return static_cast<std::uint8_t>(counter & 0xFF); }
  void set_low(unsigned low) { counter = static_cast<std::uint16_t>((counter & 0x700) | low); }
  void set_high(unsigned high) { counter = static_cast<std::uint16_t>((high & 7) << 8 | low()); }
};

// Stored and used in the bytes of the state in which other schemes have RAM.
struct Chip {
  [[gnu::packed]] double fraction;  // of a music clock that has not ended
  std::array<Fetcher, kFetchers> fetcher;
  std::uint8_t random, spare[7];
};
static_assert(sizeof(Chip) <= kRamInState && std::is_trivially_copyable_v<Chip>);
static_assert(alignof(Chip) <= alignof(CartridgeState));

inline Chip& chip_of(CartridgeSlot& slot) {
  return *std::launder(reinterpret_cast<Chip*>(slot.state.ram.data()));
}

// Sets the chip up at power-on only: a reset does not change the fetchers.
inline void power_on(CartridgeSlot& slot) {
  chip_of(slot) = Chip{};
  chip_of(slot).random = 1;
}

inline void reset(CartridgeSlot& slot) {
  atari::reset(slot);
  chip_of(slot).fraction = 0;
}

inline void map(CartridgeSlot& slot) {
  slot.map.show(kPorts, atari::bank(slot) + kPorts, kHotPage - kPorts);
  slot.map.hide(0, kPorts);
  slot.map.hide(kHotPage, MemoryMap::kPageSize);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned selected = (address & 0xFFFU) - slot.scheme.first_hot_spot;
  if (selected >= slot.scheme.banks) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(selected);
  map(slot);
}

constexpr std::array<std::uint8_t, 256> kNextRandom = [] {
  std::array<std::uint8_t, 256> next{};
  for (unsigned r = 0; r < next.size(); ++r)
    next[r] = static_cast<std::uint8_t>(r << 1 | (~(r >> 7 ^ r >> 5 ^ r >> 4 ^ r >> 3) & 1));
  return next;
}();

inline void clock_random(Chip& chip) { chip.random = kNextRandom[chip.random]; }

// All bits set if the condition holds, otherwise none. Flags are computed without branches, which would
// depend on the music and be predicted badly.
constexpr unsigned mask_of(bool condition) { return 0U - static_cast<unsigned>(condition); }

// A music fetcher wraps from 0 to its top. Its output is high from the top down to the bottom.
inline void count_down(Fetcher& fetcher, int clocks) {
  const int period = fetcher.top + 1;
  if (clocks >= period) [[unlikely]]  // a division is slow
    clocks %= period;
  int low = fetcher.top == 0 ? 0 : fetcher.low() - clocks;
  low += static_cast<int>(mask_of(low < 0)) & period;
  fetcher.set_low(static_cast<unsigned>(low));
  fetcher.flag =
      static_cast<std::uint8_t>((fetcher.flag | mask_of(low <= fetcher.top)) & mask_of(low > fetcher.bottom));
}

// Music clocks in a number of cycles. A table avoids the division for the usual ones.
constexpr double divided_clocks(std::int32_t cycles) { return 15750.0 * cycles / 1193191.66666667; }

constexpr std::array<double, 256> kClocks = [] {
  std::array<double, 256> clocks{};
  for (std::int32_t cycles = 0; cycles < 256; ++cycles)
    clocks[static_cast<std::size_t>(cycles)] = divided_clocks(cycles);
  return clocks;
}();

inline double clocks_in(std::int32_t cycles) {
  const auto number = static_cast<std::uint32_t>(cycles);
  return number < kClocks.size() ? kClocks[number] : divided_clocks(cycles);
}

inline void run_music(CartridgeSlot& slot, Chip& chip, std::int32_t cycle) {
  const auto passed =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(cycle) - slot.machine.frame.cartridge_clock);
  slot.machine.frame.cartridge_clock = static_cast<std::uint32_t>(cycle);
  const double clocks = clocks_in(passed) + chip.fraction;
  const int whole = static_cast<int>(clocks);
  chip.fraction = clocks - whole;
  if (whole <= 0) return;
  for (unsigned i = kFirstMusic; i < kFetchers; ++i)
    if (chip.fetcher[i].music) count_down(chip.fetcher[i], whole);
}

// The three voices, mixed by resistors.
inline std::uint8_t amplitude(const Chip& chip) {
  static constexpr std::uint8_t kLevels[8] = {0, 4, 5, 9, 6, 10, 11, 15};
  unsigned voices = 0;
  for (unsigned i = kFirstMusic; i < kFetchers; ++i)
    voices |= static_cast<unsigned>(chip.fetcher[i].music & chip.fetcher[i].flag) << (i - kFirstMusic);
  return kLevels[voices];
}

// The functions of a fetcher: what a read at function (address >> 3 & 7) gives. The others give 0.
enum Function : unsigned { kRandomOrSound, kDisplayed, kMasked, kFlag = 7 };

template <unsigned kFunction>
std::uint8_t fetch(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle) {
  Chip& chip = chip_of(slot);
  clock_random(chip);
  const unsigned number = address & 7;
  Fetcher& fetcher = chip.fetcher[number];
  const unsigned not_at_bottom = mask_of(fetcher.low() != fetcher.bottom);
  fetcher.flag =
      static_cast<std::uint8_t>((fetcher.flag & not_at_bottom) | mask_of(fetcher.low() == fetcher.top));

  const auto displayed = [&] { return slot.rom[kDisplay + kDisplaySize - 1 - fetcher.counter]; };
  std::uint8_t result = 0;
  if (kFunction == kRandomOrSound && number < kFirstSound) {
    result = chip.random;
  } else if (kFunction == kRandomOrSound) {
    run_music(slot, chip, cycle);
    result = amplitude(chip);
  } else if (kFunction == kDisplayed) {
    result = displayed();
  } else if (kFunction == kMasked) {
    result = displayed() & fetcher.flag;
  } else if (kFunction == kFlag) {
    result = fetcher.flag;
  }
  if (!fetcher.music) fetcher.counter = (fetcher.counter - 1) & (kDisplaySize - 1);
  return result;
}

constexpr unsigned function_at(std::uint16_t address) { return address >> 3 & 7; }

// Whether the address reads a value through a fetcher that cannot make music.
constexpr bool is_plain_fetch(std::uint16_t address) {
  if ((address & 0xFFF) >= kReadPort) return false;
  const unsigned function = function_at(address), number = address & 7;
  if (function == kRandomOrSound) return number < kFirstSound;
  return number < kFirstMusic && (function == kDisplayed || function == kMasked || function == kFlag);
}

// An address without a fetcher reads the image.
inline std::uint8_t read_image(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  clock_random(chip_of(slot));
  return atari::bank(slot)[address & 0xFFF];
}

inline PortReader port_reader(std::uint16_t address) {
  static constexpr PortReader kReaders[8] = {fetch<0>, fetch<1>, fetch<2>, fetch<3>,
                                             fetch<4>, fetch<5>, fetch<6>, fetch<7>};
  const unsigned offset = address & 0xFFF;
  if (offset < kReadPort) return kReaders[function_at(address)];
  return offset < kPorts ? read_image : nullptr;
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

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  Chip chip;
  std::memcpy(&chip, state.ram.data(), sizeof chip);
  for (unsigned i = 0; i < kFetchers; ++i) {
    const Fetcher& fetcher = chip.fetcher[i];
    if (fetcher.counter >= kDisplaySize || (fetcher.flag != 0 && fetcher.flag != 0xFF)) return false;
    if (fetcher.music > (i >= kFirstMusic ? 1 : 0)) return false;
  }
  const bool is_fraction = chip.fraction > -1 && chip.fraction < 1;
  const bool spare_is_clear = std::ranges::all_of(chip.spare, [](std::uint8_t byte) { return byte == 0; });
  return atari::admits(slot, state) && is_fraction && spare_is_clear;
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle) {
  if (const PortReader reader = port_reader(address)) return reader(slot, address, cycle);
  touch(slot, address);
  return read_image(slot, address, cycle);
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  const unsigned offset = address & 0xFFF;
  touch(slot, address);
  Chip& chip = chip_of(slot);
  clock_random(chip);
  if (offset >= kReadPort && offset < kPorts) set_register(chip, address, value);
  return Delivery::kTaken;
}

}  // namespace racebeam::dpc

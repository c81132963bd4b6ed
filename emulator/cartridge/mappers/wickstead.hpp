// Wickstead Design's WD. Four segments of 1K show four of eight slices. An access to $30-$3F, which are the
// TIA's addresses, too, selects one of eight arrangements. Programs access one by LDA, and leave by JMP. So
// the next three accesses of the cartridge still find the old one. 64 bytes of RAM are read at $1000-$103F,
// and written at $1040-$107F, where ROM is read. WDSW is a bad dump of such a cartridge, in which two slices
// have changed places.
#pragma once

#include <array>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::wickstead {

constexpr unsigned kSlice = 1024, kSegments = 4, kRam = 64, kArrangements = 8;
constexpr std::uint8_t kDelay = 3;
constexpr unsigned kShown = 0, kNext = 1, kDelayLeft = 2;  // indices of the state's banks

constexpr std::array<std::array<std::uint8_t, kSegments>, kArrangements> kSlices = {{{0, 0, 1, 3},
                                                                                     {0, 1, 2, 3},
                                                                                     {4, 5, 6, 7},
                                                                                     {7, 4, 2, 3},
                                                                                     {0, 0, 6, 7},
                                                                                     {0, 1, 7, 6},
                                                                                     {2, 3, 4, 5},
                                                                                     {6, 0, 5, 1}}};

enum Version : std::uint8_t { kRight, kSwapped };  // Scheme::version

inline const std::uint8_t* segment(const CartridgeSlot& slot, unsigned number) {
  unsigned slice = kSlices[slot.state.bank[kShown]][number];
  if (slot.scheme.version == kSwapped && (slice == 2 || slice == 3)) slice ^= 1;
  return slot.rom.data() + kSlice * slice;
}

inline void reset(CartridgeSlot& slot) { slot.state.bank = {}; }

inline void map(CartridgeSlot& slot) {
  if (slot.state.bank[kDelayLeft] > 0) return slot.map.hide(0, kSegments * kSlice);
  for (unsigned number = 0; number < kSegments; ++number)
    slot.map.show(kSlice * number, segment(slot, number), kSlice);
  slot.map.show(0, slot.ram.data(), kRam);
}

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  const auto& bank = state.bank;
  return bank[kShown] < kArrangements && bank[kNext] < kArrangements && bank[kDelayLeft] <= kDelay &&
         banks_unused(state, 3);
}

inline void select(CartridgeSlot& slot, std::uint16_t address) {
  slot.state.bank[kNext] = address % kArrangements;
  slot.state.bank[kDelayLeft] = kDelay;
  map(slot);
}

// Counts an access of the cartridge. The last one of the delay shows the selected arrangement.
inline void count_access(CartridgeSlot& slot) {
  auto& bank = slot.state.bank;
  if (bank[kDelayLeft] == 0 || --bank[kDelayLeft] > 0) return;
  bank[kShown] = bank[kNext];
  map(slot);
}

inline bool is_hot_spot(std::uint16_t address) { return (address & 0x1FF0) == 0x0030; }

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  if (is_hot_spot(address)) select(slot, address);
  if ((address & 0x1000) == 0) return 0;
  const unsigned offset = address & 0xFFF;
  const std::uint8_t value =
      offset < kRam ? slot.ram[offset] : segment(slot, offset / kSlice)[offset % kSlice];
  count_access(slot);
  return value;
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  if (is_hot_spot(address)) select(slot, address);
  if ((address & 0x1000) == 0) return Delivery::kToTia;
  const unsigned offset = address & 0xFFF;
  if (offset >= kRam && offset < 2 * kRam) slot.ram[offset - kRam] = value;
  count_access(slot);
  return Delivery::kTaken;
}

}  // namespace racebeam::wickstead

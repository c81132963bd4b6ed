// Tigervision's 3F. Banks of 2K: the one at $1000 is chosen by writing its number to $0000-$003F, the last one stays
// at $1800. Reading $0000-$003F gives the bank's bytes, not the TIA; use the TIA's mirrors from $0040 on. Writes to
// the cartridge reach the TIA too, and $1000-$103F selects like $0000-$003F.
#pragma once

#include "emulator/scheme.hpp"

namespace racebeam::tigervision {

constexpr unsigned kBankSize = 2048;

inline unsigned banks(const Slot& slot) { return static_cast<unsigned>(slot.rom.size()) / kBankSize; }

inline void reset(Slot& slot) { slot.state.bank[0] = 0; }

inline void map(Slot& slot) {
  const std::uint8_t* bank = slot.rom.data() + kBankSize * slot.state.bank[0];
  slot.map.show(0, bank, kBankSize);
  slot.map.show(kBankSize, slot.rom.data() + kBankSize * (banks(slot) - 1), kBankSize);
  slot.map.page[0] = slot.map.page[0x2000 >> 6] = bank;
}

inline void write(Slot& slot, std::uint16_t address, std::uint8_t value) {
  if ((address & 0x0FFF) >= 0x40) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(value % banks(slot));
  map(slot);
}

}  // namespace racebeam::tigervision

// Dynacom's MB (Megaboy). Sixteen banks of 4K; each access to $1FF0 selects the next one.
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::dynacom {

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  if ((address & 0xFFF) != slot.scheme.first_hot_spot) return;
  slot.state.bank[0] = static_cast<std::uint8_t>((slot.state.bank[0] + 1U) % slot.scheme.banks);
  atari::map(slot);
}

constexpr auto read = atari::read_after<touch>;
constexpr auto write = atari::write_after<touch>;

}  // namespace racebeam::dynacom

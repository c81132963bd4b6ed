// UA Ltd.'s UA, and others that select one of two banks of 4K by an access outside of the cartridge. The
// access also reaches the TIA or the RIOT. Clones of UA decode fewer bits (Digivision), others choose other
// addresses: 0FA0 (Fotomania), 0840 ("EconoBanking").
#pragma once

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::ua {

// The address bits that count, and their values that select the banks.
struct Decoder {
  unsigned mask, bank0, bank1;
};

inline constexpr Decoder kUa{0x1FFF, 0x0220, 0x0240}, kClone{0x1260, 0x0220, 0x0240},
    kSwapped{0x1260, 0x0240, 0x0220}, k0fa0{0x16E0, 0x06A0, 0x06C0}, k0840{0x1840, 0x0800, 0x0840};

inline void map(CartridgeSlot& slot) { slot.map.show(0, atari::bank(slot), atari::kBankSize); }

template <Decoder kDecoder>
void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned place = address & kDecoder.mask;
  if (place != kDecoder.bank0 && place != kDecoder.bank1) return;
  slot.state.bank[0] = place == kDecoder.bank1;
  map(slot);
}

// Accesses of a cartridge whose banks `kTouch` selects by their addresses.
using Touch = void (*)(CartridgeSlot&, std::uint16_t);

template <Touch kTouch>
std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  kTouch(slot, address);
  return 0;
}

template <Touch kTouch>
Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  kTouch(slot, address);
  return address & 0x1000 ? Delivery::kTaken : Delivery::kToTia;
}

template <Decoder kDecoder>
inline constexpr MapperOps kOps = {atari::reset, map, read<touch<kDecoder>>, write<touch<kDecoder>>,
                                   atari::admits};

}  // namespace racebeam::ua

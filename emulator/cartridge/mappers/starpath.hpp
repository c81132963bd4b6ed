// Starpath's AR, the Supercharger: 6K of RAM in three banks of 2K, filled from the "loads" of the image
// (originally from tape), and a BIOS of 2K that performs the loading. $1000-$17FF and $1800-$1FFF show two of
// the four, as a configuration byte selects. An access to $10xx notes xx as a value, and one to $1FF8 makes
// it the configuration.
//
// On the chip, a noted value could also be written to RAM five bus cycles later. In the reference this never
// happens, because its CPU core does not count those cycles. So RAM changes by loads only
// (docs/spec/cartridges.md, 9).
#pragma once

#include <algorithm>
#include <array>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::starpath {

constexpr unsigned kBank = 2048, kBios = 3;
constexpr unsigned kLoad = 8448, kHeader = 8192, kPage = 256;
constexpr std::uint16_t kConfigure = 0x1FF8, kLoader = 0x1850;

// A BIOS of our own, since the specification does not have one. (The reference's also shows a picture for
// some frames.) From $F80A it clears RAM and requests load 0; from $F800 it requests the load whose number is
// in $FA. It starts the program with the last six bytes of RAM, CMP $FFF8 and JMP: with the configuration and
// at the address that came with the load.
inline constexpr std::uint8_t kBiosCode[] = {
    0xA5, 0xFA,                                      // F800  LDA $FA
    0x4C, 0x18, 0xF8,                                //       JMP $F818
    0xEA, 0xEA, 0xEA, 0xEA, 0xEA,                    //
    0x78, 0xD8, 0xA2, 0xFF, 0x9A,                    // F80A  SEI, CLD, LDX #$FF, TXS
    0xA9, 0x00, 0xA2, 0x80,                          //       LDA #0, LDX #$80
    0x95, 0x00, 0xE8, 0xD0, 0xFB,                    // F813  STA 0,X, INX, BNE $F813
    0x85, 0x80,                                      // F818  STA $80
    0xAD, 0x50, 0xF8,                                //       LDA $F850
    0xA9, 0xCD, 0x85, 0xFA, 0xA9, 0xF8, 0x85, 0xFB,  //       CMP $FFF8 to $FA
    0xA9, 0xFF, 0x85, 0xFC, 0xA9, 0x4C, 0x85, 0xFD,  //       JMP       to $FD
    0xA6, 0x80,                                      //       LDX $80
    0xDD, 0x00, 0xF0,                                //       CMP $F000,X
    0x4C, 0xFA, 0x00,                                //       JMP $00FA
};

inline constexpr std::array<std::uint8_t, kBank> kBiosRom = [] {
  std::array<std::uint8_t, kBank> rom{};
  std::copy(std::begin(kBiosCode), std::end(kBiosCode), rom.begin());
  constexpr std::uint8_t kVectors[] = {0x02, 0x02, 0x0A, 0xF8, 0x0A, 0xF8};  // as the reference's
  std::copy(std::begin(kVectors), std::end(kVectors), rom.end() - std::size(kVectors));
  return rom;
}();

enum Register { kConfiguration, kNoted, kPending };  // indices of CartridgeState::bank

inline unsigned bank_shown(const CartridgeSlot& slot, bool upper) {
  static constexpr std::uint8_t kBanks[8][2] = {{2, 3}, {0, 3}, {2, 0}, {0, 2},
                                                {2, 3}, {1, 3}, {2, 1}, {1, 2}};
  return kBanks[slot.state.bank[kConfiguration] >> 2 & 7][upper];
}

inline bool ram_is_writable(const CartridgeSlot& slot) { return (slot.state.bank[kConfiguration] & 2) != 0; }

inline const std::uint8_t* memory(const CartridgeSlot& slot, bool upper) {
  const unsigned bank = bank_shown(slot, upper);
  return bank == kBios ? kBiosRom.data() : slot.ram.data() + kBank * bank;
}

inline void reset(CartridgeSlot& slot) { slot.state.bank = {}; }

inline void map(CartridgeSlot& slot) {
  for (const bool upper : {false, true}) slot.map.show(upper * kBank, memory(slot, upper), kBank);
  slot.map.hide(0, kPage);
  for (const unsigned place : {kLoader, kConfigure})
    slot.map.hide((place & 0xFFFU) / MemoryMap::kPageSize * MemoryMap::kPageSize, MemoryMap::kPageSize);
}

// The load that RIOT RAM $80 requests, or null.
inline const std::uint8_t* requested_load(const CartridgeSlot& slot) {
  for (std::size_t at = 0; at + kLoad <= slot.rom.size(); at += kLoad)
    if (slot.rom[at + kHeader + 5] == slot.machine.riot.ram[0]) return slot.rom.data() + at;
  return nullptr;
}

// Copies the pages of the requested load to the places that its header lists, and the start address and the
// configuration to RIOT RAM.
inline void load(CartridgeSlot& slot) {
  const std::uint8_t* from = requested_load(slot);
  if (from == nullptr) return;
  const std::uint8_t* header = from + kHeader;
  const unsigned pages = std::min<unsigned>(header[3], kHeader / kPage);
  for (unsigned page = 0; page < pages; ++page) {
    const unsigned bank = header[16 + page] & 3, place = header[16 + page] >> 2 & 7;
    if (bank != kBios)
      std::copy_n(from + kPage * page, kPage, slot.ram.begin() + kBank * bank + kPage * place);
  }
  auto& ram = slot.machine.riot.ram;
  ram[0x7E] = header[0];
  ram[0x7F] = header[1];
  ram[0x00] = header[2];
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned place = address & 0x1FFF;
  if ((place & 0xF00) == 0 && !(ram_is_writable(slot) && slot.state.bank[kPending])) {
    slot.state.bank[kNoted] = static_cast<std::uint8_t>(address & 0xFF);
    slot.state.bank[kPending] = 1;
  } else if (place == kConfigure) {
    slot.state.bank[kPending] = 0;
    slot.state.bank[kConfiguration] = slot.state.bank[kNoted];
    map(slot);
  }
}

inline bool admits(const CartridgeSlot&, const CartridgeState& state) {
  return state.bank[kPending] <= 1 && banks_unused(state, kPending + 1);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  if ((address & 0x1FFF) == kLoader && bank_shown(slot, true) == kBios) load(slot);
  touch(slot, address);
  return memory(slot, (address & kBank) != 0)[address % kBank];
}

inline Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t) {
  touch(slot, address);
  return Delivery::kTaken;
}

}  // namespace racebeam::starpath

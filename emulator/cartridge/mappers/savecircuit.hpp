// EFF: EF with AtariAge's circuit for saving, an EEPROM of 2048 bytes of the type 24xx16. Accesses set its
// two lines: $1FF0 and $1FF1 the clock, $1FF2 and $1FF3 the data. $1FF4 reads the data line in bit 0. The
// EEPROM keeps its bytes through a reset (docs/spec/cartridges.md, 11).
#pragma once

#include <algorithm>
#include <cstring>
#include <new>

#include "emulator/cartridge/mappers/atari.hpp"

namespace racebeam::savecircuit {

constexpr unsigned kBytes = 2048, kPage = 256;
constexpr unsigned kClock = 0xFF0, kData = 0xFF2, kDataRead = 0xFF4;
constexpr std::uint8_t kControl = 0xA0, kByteBits = 8, kEmpty = 0xFF;

// The meaning of the bits that the 6507 transfers next.
enum Phase : std::uint8_t { kIdle, kSelects, kAddresses, kWrites, kReads };

// In the bytes of the state in which other schemes have RAM. The lines are 1 if nobody pulls them low.
struct Eeprom {
  std::uint16_t pointer;
  std::uint8_t phase;
  std::uint8_t bits;   // bits of the present byte that have been transferred; the ninth acknowledges the byte
  std::uint8_t shift;  // the transferred bits, the last one lowest
  std::uint8_t clock, data;
  std::uint8_t pulls;  // the EEPROM pulls the data line low
};
static_assert(sizeof(Eeprom) <= kRamInState && std::has_unique_object_representations_v<Eeprom>);

inline Eeprom& eeprom_of(CartridgeSlot& slot) {
  return *std::launder(reinterpret_cast<Eeprom*>(slot.state.ram.data()));
}

inline void power_on(CartridgeSlot& slot) { std::ranges::fill(slot.ram, kEmpty); }

inline void reset(CartridgeSlot& slot) {
  atari::reset(slot);
  eeprom_of(slot) = {.pointer = 0, .phase = kIdle, .bits = 0, .shift = 0, .clock = 1, .data = 1, .pulls = 0};
}

inline void map(CartridgeSlot& slot) {
  const unsigned quiet = slot.scheme.first_hot_spot % MemoryMap::kPageSize;
  slot.map.show(0, atari::bank(slot), atari::kBankSize);
  slot.map.hide(slot.scheme.first_hot_spot - quiet, MemoryMap::kPageSize, quiet);
}

inline bool admits(const CartridgeSlot& slot, const CartridgeState& state) {
  Eeprom eeprom;
  std::memcpy(&eeprom, state.ram.data(), sizeof eeprom);
  return atari::admits(slot, state) && eeprom.pointer < kBytes && eeprom.phase <= kReads &&
         eeprom.bits <= kByteBits + 1 && eeprom.clock <= 1 && eeprom.data <= 1 && eeprom.pulls <= 1;
}

inline void advance_pointer(Eeprom& eeprom) {
  eeprom.pointer = static_cast<std::uint16_t>((eeprom.pointer + 1) % kBytes);
}

// Receives a byte. Returns whether the EEPROM acknowledges it.
inline bool accept(CartridgeSlot& slot, Eeprom& eeprom) {
  const std::uint8_t byte = eeprom.shift;
  switch (eeprom.phase) {
    case kSelects:
      if ((byte & 0xF0) != kControl) {
        eeprom.phase = kIdle;
        return false;
      }
      eeprom.pointer = static_cast<std::uint16_t>(kPage * (byte >> 1 & 7) + eeprom.pointer % kPage);
      eeprom.phase = byte & 1 ? kReads : kAddresses;
      break;
    case kAddresses:
      eeprom.pointer = static_cast<std::uint16_t>(eeprom.pointer / kPage * kPage + byte);
      eeprom.phase = kWrites;
      break;
    default:
      slot.ram[eeprom.pointer] = byte;
      advance_pointer(eeprom);
      break;
  }
  return true;
}

// The data line is read when the clock rises. The 6507 does not acknowledge the last byte that it reads.
inline void rise(Eeprom& eeprom) {
  if (eeprom.phase == kIdle) return;
  const bool is_last = eeprom.bits == kByteBits;
  if (is_last && eeprom.phase == kReads && eeprom.data && !eeprom.pulls) eeprom.phase = kIdle;
  if (!is_last) eeprom.shift = static_cast<std::uint8_t>(eeprom.shift << 1 | (eeprom.data && !eeprom.pulls));
  ++eeprom.bits;
}

// The EEPROM changes the data line when the clock falls.
inline void fall(CartridgeSlot& slot, Eeprom& eeprom) {
  const bool reads = eeprom.phase == kReads;
  eeprom.pulls = 0;
  if (eeprom.phase == kIdle) return;
  if (eeprom.bits == kByteBits && !reads) eeprom.pulls = accept(slot, eeprom);
  if (eeprom.bits == kByteBits && reads) advance_pointer(eeprom);
  if (eeprom.bits > kByteBits) eeprom.bits = 0;
  if (eeprom.phase == kReads && eeprom.bits < kByteBits)
    eeprom.pulls = (slot.ram[eeprom.pointer] << eeprom.bits & 0x80) == 0;
}

inline void set_clock(CartridgeSlot& slot, bool level) {
  Eeprom& eeprom = eeprom_of(slot);
  if (eeprom.clock == level) return;
  eeprom.clock = level;
  level ? rise(eeprom) : fall(slot, eeprom);
}

// A change while the clock is high begins or ends a transfer.
inline void set_data(CartridgeSlot& slot, bool level) {
  Eeprom& eeprom = eeprom_of(slot);
  if (eeprom.data == level) return;
  eeprom.data = level;
  if (!eeprom.clock) return;
  eeprom.phase = level ? kIdle : kSelects;
  eeprom.bits = eeprom.shift = eeprom.pulls = 0;
}

inline void select(CartridgeSlot& slot, unsigned bank) {
  if (bank >= slot.scheme.banks) return;
  slot.state.bank[0] = static_cast<std::uint8_t>(bank);
  map(slot);
}

inline void touch(CartridgeSlot& slot, std::uint16_t address) {
  const unsigned spot = address & 0xFFFU;
  select(slot, spot - slot.scheme.first_hot_spot);
  if ((spot & 0xFFEU) == kClock) set_clock(slot, (spot & 1) != 0);
  if ((spot & 0xFFEU) == kData) set_data(slot, (spot & 1) != 0);
}

inline std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t) {
  touch(slot, address);
  const std::uint8_t byte = atari::bank(slot)[address & 0xFFFU];
  if ((address & 0xFFFU) != kDataRead) return byte;
  const Eeprom& eeprom = eeprom_of(slot);
  return static_cast<std::uint8_t>((byte & 0xFE) | (eeprom.data && !eeprom.pulls));
}

constexpr auto write = atari::write_after<touch>;

}  // namespace racebeam::savecircuit

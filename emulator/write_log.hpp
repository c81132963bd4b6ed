// TIA accesses as data: the CPU appends, the TIA plays them when somebody looks (design: nothing ticks).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/registers.hpp"

namespace racebeam {

// One word, so that it is written and compared as such.
class TiaAccess {
 public:
  TiaAccess() = default;
  TiaAccess(std::int32_t cycle, unsigned reg, std::uint8_t value)
      : packed_(static_cast<std::uint64_t>(cycle) << 16 | reg << 8 | value) {}

  std::int32_t cycle() const { return static_cast<std::int32_t>(packed_ >> 16); }
  unsigned reg() const { return packed_ >> 8 & 0xFF; }  // $00-$2C; kTouch: draws up to its clock, changes nothing
  std::uint8_t value() const { return static_cast<std::uint8_t>(packed_); }

  // Cycle from `first_cycle` on, register and value: what makes two lines the same.
  std::uint32_t since(std::int32_t first_cycle) const {
    return static_cast<std::uint32_t>(packed_ - (static_cast<std::uint64_t>(first_cycle) << 16));
  }

 private:
  std::uint64_t packed_;
};

constexpr std::uint8_t kTouch = 0x3F;

// Accesses in the order in which they were made.
struct AccessList {
  static constexpr std::size_t kCapacity = 16384;

  std::size_t size = 0;
  std::array<TiaAccess, kCapacity> entry;

  void append(TiaAccess access) { entry[size++] = access; }
};

// One step's accesses, twice: those that may change the picture, and all. Most writes repeat what the register holds;
// they matter only to how far the reference has drawn ahead when a picture stops in the middle, which is rare. A step
// without a TIA write past the line limit has at most 343 lines of 76 cycles, and no instruction makes more than one
// access in two cycles, so that writes always fit; has_room() is for the reads.
class WriteLog {
 public:
  AccessList changes;
  AccessList all;

  void clear() {
    changes.size = all.size = 0;
    written_.fill(kUnknown);
  }

  // A write that may change the picture, whatever was written before.
  void append(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    const TiaAccess access(cycle, reg, value);
    all.append(access);
    changes.append(access);
    written_[reg] = kUnknown;
    written_[kDisturbed[reg]] |= kUnsettled;
    if (reg == HMCLR) written_[HMP0] = written_[HMP1] = written_[HMM0] = written_[HMM1] = written_[HMBL] = kUnknown;
  }

  // The same, unless it repeats the last one and the register only holds what is written.
  void append_change(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    const TiaAccess access(cycle, reg, value);
    all.append(access);
    const std::uint16_t before = written_[reg];
    if (before == value) return;
    written_[reg] = value | kNeverRepeats[reg];
    if ((before & ~kUnsettled) != value) written_[kDisturbed[reg]] |= kUnsettled;
    changes.append(access);
  }

  // Draws up to its clock and changes nothing.
  void touch(std::int32_t cycle, unsigned reg = kTouch) { all.append(TiaAccess(cycle, reg, 0)); }

  bool has_room() const { return all.size < AccessList::kCapacity - 8; }

 private:
  static constexpr std::uint16_t kUnknown = 0x100;
  static constexpr std::uint16_t kUnsettled = 0x200;  // the value is known, but writing it again does something

  // kUnknown for the registers whose writes do something each time.
  static constexpr std::array<std::uint16_t, 64> kNeverRepeats = [] {
    std::array<std::uint16_t, 64> table{};
    for (const TiaRegister reg : {NUSIZ0, NUSIZ1, CTRLPF, RESP0, RESP1, RESM0, RESM1, RESBL, HMOVE, HMCLR, CXCLR})
      table[reg] = kUnknown;
    return table;
  }();

  // A new value in these makes a write of the other one do something again: it moves the value on (tia.md, section 7).
  static constexpr std::array<std::uint8_t, 64> kDisturbed = [] {
    std::array<std::uint8_t, 64> table{};
    table.fill(kTouch);  // nobody
    table[GRP0] = table[ENABL] = GRP1;
    table[GRP1] = GRP0;
    return table;
  }();

  std::array<std::uint16_t, 64> written_{};
};

}  // namespace racebeam

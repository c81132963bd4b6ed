// TIA writes as data: the CPU appends them, and the TIA plays them when the picture or a collision is read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "emulator/tia/registers/registers.hpp"

namespace racebeam {

// A write in one word: cycle (18 bits, from the log's base on), register (6), value (8, as logged_bits()
// says). Later writes are larger words.
class TiaWrite {
 public:
  static constexpr unsigned kCycleShift = 14;

  constexpr explicit TiaWrite(std::uint32_t packed) : packed_(packed) {}
  constexpr TiaWrite(std::int32_t cycle, unsigned reg, std::uint8_t value)
      : packed_(static_cast<std::uint32_t>(cycle) << kCycleShift | reg << 8 | value) {}

  constexpr std::int32_t cycle() const { return static_cast<std::int32_t>(packed_ >> kCycleShift); }
  constexpr unsigned reg() const { return packed_ >> 8 & 0x3F; }
  constexpr std::uint8_t value() const { return static_cast<std::uint8_t>(packed_); }
  constexpr std::uint32_t packed() const { return packed_; }

 private:
  std::uint32_t packed_;
};

// The writes of a step that have not been played yet. Machines of a thread share one log, one machine at a
// time. A write that repeats the register's value is left out, and so are reads. Where their order can be
// observed, the step is run again, access by access (Board::end_step, Console::Impl::run_step). Translated
// code appends as append() and append_change() do (tests/translator/writes_test.cpp compares them), and
// expects the members at fixed offsets.
struct WriteLog {
  // A step has at most half as many instructions, and a plain store is one entry. A caller that appends more,
  // or waits, calls is_short_of_room() first. So no program can make the list or the cycle's 18 bits
  // overflow.
  static constexpr std::size_t kCapacity = 65536;
  // Cycles. 25000 instructions of 8 cycles still fit after it.
  static constexpr std::int32_t kLongestSpan = 50000;
  static constexpr std::size_t kPadding = 32;  // entries that may be read beyond the last

  static constexpr std::uint16_t kUnknown = 0x100;
  // The value is known, but writing it again does something.
  static constexpr std::uint16_t kUnsettled = 0x200;

  // kUnknown for the registers whose repeated writes act.
  static constexpr std::array<std::uint16_t, 64> kOnRepeat = [] {
    std::array<std::uint16_t, 64> table{};
    for (unsigned reg = 0; reg < table.size(); ++reg)
      if (kRegisters[reg].repeat == OnRepeat::kActs) table[reg] = kUnknown;
    return table;
  }();

  std::uint32_t* next = nullptr;            // where the next write goes
  std::int32_t base = 0;                    // the cycle that the entries' cycles count from
  std::array<std::uint16_t, 64> written{};  // each register's last value, with the marks above
  std::array<std::uint32_t, kCapacity + kPadding> entry;
  bool is_whole = true;  // the entries are all writes since begin()

  WriteLog() { begin(0); }
  WriteLog(const WriteLog&) = delete;
  WriteLog& operator=(const WriteLog&) = delete;

  void begin(std::int32_t cycle) {
    rewind(cycle);
    is_whole = true;
    written.fill(kUnknown);
  }

  // All has been played.
  void rewind(std::int32_t cycle) {
    next = entry.data();
    base = cycle;
    is_whole = false;
  }

  std::size_t size() const { return static_cast<std::size_t>(next - entry.data()); }
  bool is_short_of_room(std::int32_t cycle) const {
    return size() > kCapacity / 2 || cycle - base > kLongestSpan;
  }

  // A write that may change the picture, whatever was written before.
  void append(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    *next++ = TiaWrite(cycle - base, reg, value & logged_bits(reg)).packed();
    written[reg] = kUnknown;
    written[kRegisters[reg].renews] |= kUnsettled;
    if (reg == HMCLR)
      written[HMP0] = written[HMP1] = written[HMM0] = written[HMM1] = written[HMBL] = kUnknown;
  }

  // Appends it unless it repeats the last write and the register only holds what is written.
  void append_change(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    const unsigned before = written[reg];
    const std::uint8_t after = value & logged_bits(reg);
    if (before == after) return;
    written[reg] = static_cast<std::uint16_t>(after | kOnRepeat[reg]);
    if ((before & ~unsigned{kUnsettled}) != after) written[kRegisters[reg].renews] |= kUnsettled;
    *next++ = TiaWrite(cycle - base, reg, after).packed();
  }
};

}  // namespace racebeam

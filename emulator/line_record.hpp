// What is known about a row of a picture buffer: the registers and writes that produced it, and what the line leaves
// behind. A line that starts alike and meets the same writes need not be drawn, nor its writes be played.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "emulator/inlining.hpp"
#include "emulator/line.hpp"
#include "emulator/line_key.hpp"
#include "emulator/state.hpp"
#include "emulator/vectors.hpp"
#include "emulator/write_log.hpp"

namespace racebeam {

// A write as a line has it: with its cycle counted from the line's first one. Compared as a word.
class LineWrite {
 public:
  // `origin` is the line's first cycle, as a write of the log has it.
  constexpr LineWrite(std::uint32_t log_entry, std::uint32_t origin) : packed_(log_entry - origin) {}
  constexpr explicit LineWrite(std::uint32_t recorded) : packed_(recorded) {}

  constexpr std::uint32_t packed() const { return packed_; }
  constexpr int cycle() const { return static_cast<std::int32_t>(packed_) >> TiaWrite::kCycleShift; }
  constexpr unsigned reg() const { return packed_ >> 8 & 0x3F; }
  constexpr std::uint8_t value() const { return static_cast<std::uint8_t>(packed_); }

  // Or beyond? One in cycle 76 is at the clock at which the next line begins, and may still act on this one.
  constexpr bool is_of_line() const { return counted_up() < TiaWrite(kEarliestWrite + 77, 0, 0).packed(); }
  // It comes in this line, but takes effect in the blank of the next, and so does what comes after it.
  constexpr bool is_late() const { return cycle() >= kLineEffects[reg()].first_late_cycle; }
  // It takes effect on this line.
  bool acts_here() const { return counted_up() <= kLineEffects[reg()].last; }

 private:
  // From the earliest cycle on: larger words are later.
  constexpr std::uint32_t counted_up() const { return packed_ + TiaWrite(kEarliestWrite, 0, 0).packed(); }

  std::uint32_t packed_;
};

struct alignas(16) LineRecord {
  static constexpr std::size_t kMostEvents = 16;

  TiaRegisters start;   // at the line's first clock
  TiaRegisters end;     // when the line is over
  TiaRegisters counts;  // once it is summed up, $FF for each byte that pixels, meetings or `end` depend on,
  TiaRegisters sets;    // and for each that is known at the end: those that count, and those that are written
  Collisions meetings;  // pairs that met on the line, after the last CXCLR
  LineView view;        // why bytes count
  bool known = false;   // the buffer's row shows this line
  std::uint8_t fruitless = 0;  // so many lines that were drawn here were not met again
  bool summed_up;            // then `start` and `end` are 0 but for these bytes
  std::uint8_t count;        // of events
  std::int8_t hmove_cycle;   // of the last HMOVE, if the line kMoves
  std::array<std::uint32_t, kMostEvents> event;  // the writes, LineWrite::packed()

  // Another line is drawn here: is it to be remembered? Where nothing was of use for some frames, only now and then.
  bool is_worthwhile() {
    constexpr std::uint8_t kPatience = 16, kRest = 40;
    if (known && summed_up) fruitless = 0;
    else fruitless = fruitless < kRest ? static_cast<std::uint8_t>(fruitless + 1) : kPatience;
    return fruitless <= kPatience;
  }

  void open(const TiaRegisters& registers);

  // Takes the writes from `entry` on that act on this line alone, or as many as there is room for; returns the next one.
  const std::uint32_t* add(const std::uint32_t* entry, std::uint32_t origin);

  // So that next time the writes need not be played. That pays if there is a next time.
  void sum_up(bool pal);
};

// TiaRegisters in the processor's registers.
struct RegisterVectors {
  std::array<TwoWords, 3> part;

  RACEBEAM_INLINE explicit RegisterVectors(const TiaRegisters& registers) { read(registers); }
  RACEBEAM_INLINE void read(const TiaRegisters& registers) {
    for (std::size_t i = 0; i < 3; ++i) part[i] = of(registers, i);
  }
  RACEBEAM_INLINE void write(TiaRegisters& registers) const { registers = std::bit_cast<TiaRegisters>(part); }

  // Do they differ in nothing that decides about the line?
  RACEBEAM_INLINE bool start(const LineRecord& record) const {
    TwoWords difference{};
    for (std::size_t i = 0; i < 3; ++i) difference |= (part[i] & of(record.counts, i)) ^ of(record.start, i);
    return is_zero(difference);
  }

  // In nothing that can be seen? The registers may come out differently.
  RACEBEAM_INLINE bool look_like(const LineRecord& record) const {
    const TiaRegisters &seen = kSeenBytes[record.view.seen & 0x1FF], &control = kControlBytes[record.view.control];
    TwoWords difference{};
    for (std::size_t i = 0; i < 3; ++i) difference |= (part[i] ^ of(record.start, i)) & (of(seen, i) | of(control, i));
    return is_zero(difference);
  }

  RACEBEAM_INLINE void add_bits(const TiaRegisters& more) {
    for (std::size_t i = 0; i < 3; ++i) part[i] |= of(more, i);
  }
  RACEBEAM_INLINE void keep_bits(const TiaRegisters& mask) {
    for (std::size_t i = 0; i < 3; ++i) part[i] &= of(mask, i);
  }

  RACEBEAM_INLINE void pass(const LineRecord& record) {
    for (std::size_t i = 0; i < 3; ++i) part[i] = (part[i] & ~of(record.sets, i)) | of(record.end, i);
  }

 private:
  RACEBEAM_INLINE static TwoWords of(const TiaRegisters& registers, std::size_t i) {
    return load<TwoWords>(reinterpret_cast<const std::uint8_t*>(&registers) + i * sizeof(TwoWords));
  }
};
static_assert(sizeof(RegisterVectors) == sizeof(TiaRegisters));

}  // namespace racebeam

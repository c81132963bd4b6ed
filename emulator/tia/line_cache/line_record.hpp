// What is known about a row of a frame buffer: the registers and writes that produced it, and the registers
// at its end. A line that starts alike and has the same writes need not be drawn, nor its writes be played.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/register_vectors.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line/line.hpp"
#include "emulator/tia/line_cache/line_dependencies.hpp"
#include "emulator/tia/line_cache/line_mask.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {

// A write of a line, with its cycle counted from the line's first one. Writes are compared as words.
class LineWrite {
 public:
  // origin: the line's first cycle, as in a write of the log.
  constexpr LineWrite(std::uint32_t log_entry, std::uint32_t origin) : packed_(log_entry - origin) {}
  constexpr explicit LineWrite(std::uint32_t recorded) : packed_(recorded) {}

  constexpr std::uint32_t packed() const { return packed_; }
  constexpr int cycle() const { return static_cast<std::int32_t>(packed_) >> TiaWrite::kCycleShift; }
  constexpr unsigned reg() const { return packed_ >> 8 & 0x3F; }
  constexpr std::uint8_t value() const { return static_cast<std::uint8_t>(packed_); }

  // A write in cycle 76 is at the clock at which the next line begins, and may still affect this one.
  constexpr bool is_of_line() const { return counted_up() < TiaWrite(kEarliestWrite + 77, 0, 0).packed(); }
  // A late write comes in this line. It takes effect in the blank of the next one, as do the writes after it.
  constexpr bool is_late() const { return cycle() >= kLineEffects[reg()].first_late_cycle; }
  // Whether it takes effect on this line.
  bool acts_here() const { return counted_up() <= kLineEffects[reg()].last; }

 private:
  // Counted from the earliest cycle: larger words are later.
  constexpr std::uint32_t counted_up() const { return packed_ + TiaWrite(kEarliestWrite, 0, 0).packed(); }

  std::uint32_t packed_;
};

// Unique for each line.
using LineNumber = std::uint64_t;
constexpr LineNumber kNoLine = 0, kAnyLine = 1;  // of a record without a line; of a row whose line is unknown

// What is known of a record's line. Each state adds to the one before it.
enum class LineState : std::uint8_t {
  kOpen,        // nothing that is complete: the line is being drawn, or none has been
  kDrawn,       // its pixels, and its end after this start: a line that only looks like it is not drawn, but
                // its writes are played
  kSummarized,  // which bytes of its start decide about its end
};

struct alignas(64) LineRecord {
  static constexpr std::size_t kMaxEvents = 16;

  TiaRegisters start;  // at the line's first clock
  TiaRegisters end;    // when the line is over
  // Set by summarize(): then `start` and `end` are 0 except for the bytes that count, or are set.
  const LineMask* mask = &LineMask::kWhole;
  Collisions meetings;    // pairs that met on the line, after the last CXCLR
  Collisions cleared;     // pairs that met before it
  LineDependencies view;  // what the line depends on, from which `mask` is computed
  LineNumber number = kNoLine;
  std::uint8_t count;        // how many elements of `event` are used
  std::int16_t hmove_clock;  // of the last HMOVE, from the line's first clock, if the line kMoves
  // hash() of the lines drawn here, in even and in odd frames (flicker_detector.hpp).
  std::array<std::uint8_t, 2> hashes{};
  bool repeats = false;  // the line is that of the row before, and ends as it starts: see is_repetition_of()
  alignas(16) std::array<std::uint32_t, kMaxEvents> event;  // the writes, LineWrite::packed()

  // Derived from values that the comparisons need anyway, so that a line that recurs costs no test of a
  // state. No row shows kNoLine, so that no open record is recalled. kWhole compares all bytes of a line that
  // is drawn but not summarized. open() sets both.
  LineState state() const {
    assert(!is_summarized() || number != kNoLine);
    if (is_open()) return LineState::kOpen;
    return is_summarized() ? LineState::kSummarized : LineState::kDrawn;
  }
  bool is_open() const { return number == kNoLine; }
  bool is_summarized() const { return mask != &LineMask::kWhole; }

  void open(const TiaRegisters& registers);

  // Takes the writes from `entry` on that affect only this line, up to the capacity. Returns the next one.
  const std::uint32_t* add(const std::uint32_t* entry, std::uint32_t origin);

  // Ends the record of a line that has been drawn. tia: as the line has left it. first_clock: the line's.
  void close(const TiaState& tia, std::int32_t first_clock);

  // A hash of what the line's pixels are made from. Only while it is not summarized.
  std::uint8_t hash() const;

  // Computes the masks, so that the writes need not be played next time. Worthwhile only if the line recurs.
  // If there are too many masks, the line stays drawn.
  void summarize(bool pal);

  // Whether the registers equal the start in all bytes that count.
  RACEBEAM_INLINE bool starts_with(const RegisterVectors& registers) const {
    TwoWords difference{};
    for (std::size_t i = 0; i < 3; ++i)
      difference |=
          (registers.part[i] & RegisterVectors::of(mask->counts, i)) ^ RegisterVectors::of(start, i);
    return is_zero(difference);
  }

  // Whether this line repeats `before`, that of the row above: both are the same, without writes, and leave
  // the registers that count as they are. If the row above has recurred, so has this one.
  bool is_repetition_of(const LineRecord& before) const;

  // Compares only the bytes that pixels depend on. The registers may end differently.
  RACEBEAM_INLINE bool looks_like(const RegisterVectors& registers) const {
    RegisterVectors difference(start);
    for (std::size_t i = 0; i < 3; ++i) difference.part[i] ^= registers.part[i];
    difference &= seen_bytes();
    return is_zero(difference.part[0] | difference.part[1] | difference.part[2]);
  }

  // Replaces the registers at the line's start by those at its end.
  RACEBEAM_INLINE void pass(RegisterVectors& registers) const {
    assert(!is_open() && !must_be_played());
    for (std::size_t i = 0; i < 3; ++i)
      registers.part[i] =
          (registers.part[i] & ~RegisterVectors::of(mask->sets, i)) | RegisterVectors::of(end, i);
  }

 private:
  // If the registers at the end depend on more than those at the start, no line starts with this record:
  // a byte of `start` then has a value that no machine's has, so that starts_with() finds a difference.
  void set_foreseen(bool foreseen) { start.spare[0] = foreseen ? 0 : kNever; }
  static constexpr std::uint8_t kNever = 1;
  bool must_be_played() const { return start.spare[0] == kNever; }

  RACEBEAM_INLINE RegisterVectors seen_bytes() const {
    RegisterVectors bytes(kSeenBytes[view.seen & 0x1FF]);
    return bytes |= RegisterVectors(kControlBytes[view.control]);
  }
};

}  // namespace racebeam

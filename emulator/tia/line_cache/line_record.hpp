// What is known about a row of a picture buffer: the registers and writes that produced it, and what the line leaves
// behind. A line that starts alike and meets the same writes need not be drawn, nor its writes be played.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/line/line.hpp"
#include "emulator/tia/line_cache/line_dependencies.hpp"
#include "emulator/tia/line_cache/line_mask.hpp"
#include "emulator/tia/registers/register_vectors.hpp"
#include "emulator/tia/registers/write_log.hpp"

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

// No two lines have the same.
using LineNumber = std::uint64_t;
constexpr LineNumber kNoLine = 0, kAnyLine = 1;  // of a record without a line; of a row whose line nobody knows

struct alignas(64) LineRecord {
  static constexpr std::size_t kMostEvents = 16;

  TiaRegisters start;   // at the line's first clock
  TiaRegisters end;     // when the line is over
  const LineMask* mask = nullptr;  // once it is summed up: then `start` and `end` are 0 but for the bytes that count, and are set
  Collisions meetings;  // pairs that met on the line, after the last CXCLR
  LineDependencies view;        // why bytes count
  LineNumber number = kNoLine;
  std::uint8_t fruitless = 0;  // so many lines that were drawn here were not met again
  std::uint8_t count;        // of events
  std::int8_t hmove_cycle;   // of the last HMOVE, if the line kMoves
  std::array<std::uint8_t, 2> hashes{};  // hash() of lines drawn here, in even and in odd frames (flicker.hpp)
  alignas(16) std::array<std::uint32_t, kMostEvents> event;  // the writes, LineWrite::packed()

  // Another line is drawn here: is it to be remembered? Where nothing was of use for some frames, only now and then.
  bool is_worthwhile() {
    constexpr std::uint8_t kPatience = 16, kRest = 40;
    if (number != kNoLine && mask != nullptr) fruitless = 0;
    else fruitless = fruitless < kRest ? static_cast<std::uint8_t>(fruitless + 1) : kPatience;
    return fruitless <= kPatience;
  }

  void open(const TiaRegisters& registers);

  // Takes the writes from `entry` on that act on this line alone, or as many as there is room for; returns the next one.
  const std::uint32_t* add(const std::uint32_t* entry, std::uint32_t origin);

  // A hash of what the line's pixels come from; before it is summed up.
  std::uint8_t hash() const;

  // So that next time the writes need not be played. That pays if there is a next time.
  void summarize(bool pal);

  // Do they differ from the start in nothing that decides about the line? Once it is summed up.
  RACEBEAM_INLINE bool starts_with(const RegisterVectors& registers) const {
    TwoWords difference{};
    for (std::size_t i = 0; i < 3; ++i)
      difference |= (registers.part[i] & RegisterVectors::of(mask->counts, i)) ^ RegisterVectors::of(start, i);
    return is_zero(difference);
  }

  // In nothing that can be seen? They may come out differently.
  RACEBEAM_INLINE bool looks_like(const RegisterVectors& registers) const {
    RegisterVectors difference(start);
    for (std::size_t i = 0; i < 3; ++i) difference.part[i] ^= registers.part[i];
    difference &= seen_bytes();
    return is_zero(difference.part[0] | difference.part[1] | difference.part[2]);
  }

  // Those at the line's start become those at its end.
  RACEBEAM_INLINE void pass(RegisterVectors& registers) const {
    for (std::size_t i = 0; i < 3; ++i)
      registers.part[i] = (registers.part[i] & ~RegisterVectors::of(mask->sets, i)) | RegisterVectors::of(end, i);
  }

 private:
  RACEBEAM_INLINE RegisterVectors seen_bytes() const {
    RegisterVectors bytes(kSeenBytes[view.seen & 0x1FF]);
    return bytes |= RegisterVectors(kControlBytes[view.control]);
  }
};

}  // namespace racebeam

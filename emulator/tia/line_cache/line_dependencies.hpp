// Which registers have a say in a line: two lines that meet the same writes, and start with the same values in the
// registers that the first one looked at, have the same pixels and collisions. An object that is not shown may drift
// about, be resized and recoloured as it likes.
//
// The argument, for the one who changes something here. An object is shown while it is enabled (objects.hpp). Whether
// it is depends on few bytes, its *control*: graphics and VDELPx, ENAxx, RESMPx, the playfield's bits. A write that
// acts on an object's control makes these bytes part of the key; for the other objects the bit that says if they are
// enabled is enough, because it stays what it was. So both lines show the same objects at the same clocks, and an
// object that was never shown while the first one was drawn is not shown on the second. What is left of the objects,
// *shape* and colour, counts only for those that were shown. Clocks are the same, too, for what a write waits for
// depends on the write alone, with one exception: RESPx lets the old copy be finished, so that the player's old place
// counts, shown or not, if another write follows so soon that it waits for that.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

// The registers (one bit each) whose writes may change the picture at all.
extern const std::uint64_t kDrawingRegisters;

// What a line looked at. seen: bits 0-5 an Object each, that was shown, and
constexpr std::uint16_t kScoreSeen = 1U << 6;    // the playfield in the players' colours
constexpr std::uint16_t kLit = 1U << 7;          // anything but VBLANK's black
constexpr std::uint16_t kMoves = 1U << 8;        // there is an HMOVE
constexpr std::uint16_t kClears = 1U << 9;       // there is a CXCLR: meetings before it are forgotten
// control: bits 0-5 an Object each, whose control a write acts on, and
constexpr std::uint8_t kPlaceOfP0 = 1U << 6, kPlaceOfP1 = 1U << 7;  // their old places count

struct LineDependencies {
  std::uint16_t seen;
  std::uint8_t control;
};

// Cycles before a line, in which a write may come and act on no other.
constexpr int kEarliestWrite = 4;

// What a write to a register may do to the line that it falls on.
struct LineEffect {
  std::uint32_t last;            // the largest word (LineWrite::counted_up()) with which it takes effect on this line
  std::int8_t first_late_cycle;  // from here on it acts on the next line alone, as if it were written there
  std::uint8_t control;          // see LineDependencies; RESPx: if a write follows at once
  std::uint16_t seen;            // kMoves, kClears or 0
};
extern const std::array<LineEffect, 64> kLineEffects;

extern const std::array<TiaRegisters, 512> kSeenBytes;     // $FF for each byte that counts, by LineDependencies::seen but kClears
extern const std::array<TiaRegisters, 256> kControlBytes;  // and by LineDependencies::control

}  // namespace racebeam

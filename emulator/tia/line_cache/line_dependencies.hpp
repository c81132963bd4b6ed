// Which registers a line depends on. Two lines have the same pixels and collisions if they have the same
// writes, and the same initial values of the registers that the first one depended on. An object that is not
// shown may have any position, size and colour.
//
// The argument, for changes in this file: an object is shown while it is enabled (objects.hpp). Whether it is
// enabled depends on few bytes, its *control*: graphics and VDELPx, ENAxx, RESMPx, the playfield's bits. A
// write that affects an object's control makes these bytes part of the key. For the other objects, the bit
// that tells whether they are enabled is enough, because it does not change. So both lines show the same
// objects at the same clocks. An object that was never shown on the first line is not shown on the second.
// The rest of an object's bytes, its *shape* and colour, counts only for objects that were shown. The clocks
// are also the same, because the delay of a write depends only on the write. There is one exception: RESPx
// lets the old copy be finished. The player's old position counts, shown or not, if another write follows so
// soon that it waits for that copy.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/state.hpp"

namespace racebeam {

// Bits of LineDependencies::seen. Bits 0-5: Object n was shown.
constexpr std::uint16_t kScoreSeen = 1U << 6;     // the playfield in the players' colours
constexpr std::uint16_t kLit = 1U << 7;           // something other than VBLANK's black was shown
constexpr std::uint16_t kMoves = 1U << 8;         // there is an HMOVE
constexpr std::uint16_t kClears = 1U << 9;        // there is a CXCLR, which clears earlier collisions
constexpr std::uint16_t kMayBeCosmic = 1U << 10;  // there is an HMM0, which may start the Cosmic Ark mode
constexpr std::uint16_t kRecolors = 1U << 11;     // a colour is written
// Bits of LineDependencies::control. Bits 0-5: a write affects the control of Object n.
constexpr std::uint8_t kPlaceOfP0 = 1U << 6, kPlaceOfP1 = 1U << 7;  // their old positions count

// What a line depended on.
struct LineDependencies {
  std::uint16_t seen;
  std::uint8_t control;
};

// A write at most this many cycles before a line may affect only that line.
constexpr int kEarliestWrite = 4;

// The possible effect of a write to a register on the line of its cycle.
struct LineEffect {
  std::uint32_t last;  // the largest LineWrite::counted_up() that takes effect on this line
  // From this cycle on, the write affects only the next line, as if it were written there.
  std::int8_t first_late_cycle;
  std::uint8_t control;  // see LineDependencies; for RESPx only if a write follows at once
  std::uint16_t seen;    // kMoves, kClears, kMayBeCosmic, kRecolors or 0
};
extern const std::array<LineEffect, 64> kLineEffects;

// The bits that count, by LineDependencies::seen without kClears, and by LineDependencies::control.
extern const std::array<TiaRegisters, 512> kSeenBytes;
extern const std::array<TiaRegisters, 256> kControlBytes;

}  // namespace racebeam

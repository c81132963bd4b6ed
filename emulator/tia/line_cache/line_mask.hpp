// Which bytes of the registers a line reads and sets. A game has few kinds of lines, so that records share
// these masks.
#pragma once

#include "emulator/state/state.hpp"
#include "emulator/state/tia_bytes.hpp"

namespace racebeam {

// $FF for each byte that
struct LineMask {
  TiaRegisters counts;  // pixels, collisions or the registers at the end depend on
  TiaRegisters sets;    // is known at the end: those that count, and those that are written

  static const LineMask kWhole;  // all bytes count, and are set

  // Returns the mask with these bytes. It is shared by all machines and never released. Thread-safe. Returns
  // null if there are too many masks, which only a program causes that writes at random, or no memory is
  // left.
  static const LineMask* find(ByteSet counts, ByteSet sets);
};

}  // namespace racebeam

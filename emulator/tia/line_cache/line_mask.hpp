// Masks of the bytes of TiaRegisters that a line reads and sets. A game has few kinds of lines, so that many
// records share a mask.
#pragma once

#include "emulator/state/state.hpp"
#include "emulator/state/tia_bytes.hpp"

namespace racebeam {

// Byte masks: $FF selects a byte of the registers.
struct LineMask {
  TiaRegisters counts;  // bytes at the line's start that its pixels, collisions or final registers depend on
  TiaRegisters sets;    // bytes whose values at the line's end are known: `counts`, and the written ones

  static const LineMask kWhole;  // all bytes count, and are set

  // Returns the mask with these bytes. It is shared by all machines and never released. Thread-safe. Returns
  // null if there are too many masks, which only a program causes that writes at random, or no memory is
  // left.
  static const LineMask* find(ByteSet counts, ByteSet sets);
};

}  // namespace racebeam

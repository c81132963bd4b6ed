// Which of the registers' bytes a line has to do with. A game has few kinds of lines, so that records share these.
#pragma once

#include "emulator/state/state.hpp"
#include "emulator/tia/registers/register_vectors.hpp"

namespace racebeam {

// $FF for each byte,
struct LineMask {
  TiaRegisters counts;  // that pixels, meetings or the registers at the end depend on
  TiaRegisters sets;    // that is known at the end: those that count, and those that are written

  // The one like this; it lives on, for all machines. On any thread. Null when there are too many already, which takes a
  // program that writes at random.
  static const LineMask* find(const RegisterVectors& counts, const RegisterVectors& sets);
};

}  // namespace racebeam

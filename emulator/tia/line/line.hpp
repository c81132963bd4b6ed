// One line's objects and their collisions (docs/spec/tia.md, 11).
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state/state.hpp"
#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/line/pixel_mask.hpp"

namespace racebeam {

// Pairs of objects that collide, two bits for each collision register: bit 2r+1 is D7 of register r, bit 2r
// its D6.
using Collisions = std::uint16_t;

enum Color : unsigned { kColup0, kColup1, kColupf, kColubk };  // indices of TiaRegisters::color

struct Line {
  std::array<PixelMask, kObjects> mask;  // by Object
  Collisions overlaps = 0;               // the pairs whose masks share pixels
  TiaRegisters shown;                    // the registers that the masks were made from

  std::uint8_t outdated(const TiaRegisters& tia) const;     // objects whose registers have changed since
  void refresh(const TiaState& tia, std::uint8_t objects);  // rebuilds the masks of these objects
};

// The pairs in each set of objects (bit n: Object n).
extern const std::array<Collisions, 64> kPossibleMeetings;
constexpr Collisions kAllPairs = 0xEFFF;  // D6 of CXBLPF is unused

std::uint8_t objects_of(Collisions pairs);

// Whether any pair of these objects (bit n: Object n) may meet that is not in `found`.
inline bool can_meet(std::uint8_t objects, Collisions found) {
  return (kPossibleMeetings[objects] & ~found) != 0;
}

// The pairs among these that meet in these pixels.
Collisions meetings(const Line& line, int first, int last, Collisions pairs);

}  // namespace racebeam

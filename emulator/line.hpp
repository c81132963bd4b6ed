// One line's objects, turned into pixels and collisions (spec: tia.md, sections 10 and 11).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "emulator/objects.hpp"
#include "emulator/pixel_mask.hpp"
#include "emulator/state.hpp"

namespace racebeam {

// Pairs of objects that meet, two bits a collision register: bit 2r+1 is D7 of register r, bit 2r its D6.
using Collisions = std::uint16_t;

enum Color : unsigned { kColup0, kColup1, kColupf, kColubk };  // indices of TiaRegisters::color

// Pixels of one colour, by its index in TiaRegisters::color.
struct Layer {
  PixelMask mask;
  unsigned color = 0;
};

struct Line {
  std::array<PixelMask, kObjects> mask;  // by Object
  std::array<Layer, 3> layer;            // what hides what: from the back to the front
  std::size_t layers = 0;                // so many of these; the others are empty
  std::uint8_t covered = 0;              // bit n: mask n has pixels

  std::span<const Layer> shown_layers() const { return std::span(layer).first(layers); }

  TiaRegisters shown;                    // what the masks were made from

  std::uint8_t outdated(const TiaRegisters& tia) const;     // objects whose registers are others than those
  void refresh(const TiaState& tia, std::uint8_t objects);  // makes the masks of these objects anew, and the layers
};

// Can any of these objects (bit n: Object n) meet, but for those that are `known` to?
bool can_meet(std::uint8_t objects, Collisions known);

// The pairs that meet in these pixels; those that are `known` need not be looked at.
Collisions meetings(const Line& line, int first, int last, Collisions known);

}  // namespace racebeam

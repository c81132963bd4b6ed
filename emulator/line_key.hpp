// What of the registers can be seen on a line, given the writes that it meets: two lines with the same key and the same
// writes have the same pixels and collisions. A disabled object that drifts about does not make a line another one.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/state.hpp"

namespace racebeam {

// The registers (one bit each) whose writes may change the picture at all.
extern const std::uint64_t kDrawingRegisters;

// What a write of such a register may do to the line that it falls on.
struct LineEffect {
  std::int8_t last_cycle;   // of the line, at which it still takes effect on the same line
  std::uint8_t involved;    // bit n: it may make Object n visible; and the two below
};
constexpr std::uint8_t kMovesObjects = 1U << 6, kBlanks = 1U << 7;

extern const std::array<LineEffect, 64> kLineEffects;

// `registers` with everything set to zero that can't be seen. involved: of all writes on the line.
TiaRegisters line_key(const TiaRegisters& registers, std::uint8_t involved);

// Is that `key`?
bool has_key(const TiaRegisters& registers, std::uint8_t involved, const TiaRegisters& key);

}  // namespace racebeam

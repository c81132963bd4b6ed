// Turns pictures of palette indices into planes of brightness, of one picture or the brighter of two, and
// keeps the tables that reduce planes (docs/spec/environment.md, 15).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "emulator/tia/palette.hpp"
#include "environment/observe/area_resize.hpp"

namespace racebeam {

// The brightness of each palette index: a grey_table(), or one of colour_tables().
using BrightnessTable = GreyTable;

// Returns the tables of red, green and blue.
const std::array<BrightnessTable, 3>& colour_tables(Format format);

// Fill `plane` with the brightness of `screen`, or with the brighter of each two pixels. All spans must have
// the same length, a multiple of 160.
void make_plane(std::span<const std::uint8_t> screen, const BrightnessTable& table,
                std::span<std::uint8_t> plane);
void make_brighter_plane(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                         const BrightnessTable& table, std::span<std::uint8_t> plane);

// Returns the table that reduces a plane of 160 x height to this size. It is made on first use, and the
// process shares it. Thread-safe. Throws InvalidInput for a size that AreaResize does not support.
const AreaResize& screen_resize(int height, int to_width, int to_height);

}  // namespace racebeam

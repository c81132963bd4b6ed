// Pictures of palette indices as planes of brightness, alone or the brighter of two, and the tables that make
// a plane smaller (docs/spec/environment.md, 15).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "emulator/tia/palette.hpp"
#include "environment/observe/area_resize.hpp"

namespace racebeam {

// One byte of brightness for each palette index: a grey_table(), or one of colour_tables().
using BrightnessTable = GreyTable;

// Red, green and blue of each palette index.
const std::array<BrightnessTable, 3>& colour_tables(Format format);

// A plane of a picture of palette indices, or, of each pixel, the brighter of two pictures. All spans are
// equally long, and a whole number of rows of 160.
void make_plane(std::span<const std::uint8_t> screen, const BrightnessTable& table,
                std::span<std::uint8_t> plane);
void make_brighter_plane(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                         const BrightnessTable& table, std::span<std::uint8_t> plane);

// Reduces a plane of 160 x height. Made when first asked for, and shared by the process. Throws InvalidInput
// for a size that it can't make; see AreaResize.
const AreaResize& screen_resize(int height, int to_width, int to_height);

}  // namespace racebeam

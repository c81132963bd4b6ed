// Turns pictures of palette indices into planes of brightness, of one picture or the brighter of two, and
// keeps the tables that reduce planes (docs/spec/environment.md, 15).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>

#include "environment/observe/area_resize.hpp"
#include "environment/observe/block_mean.hpp"
#include "environment/observe/brightness.hpp"
#include "environment/observe/enlarge.hpp"

namespace racebeam {

// Returns the tables of red, green and blue.
const std::array<BrightnessTable, 3>& colour_tables(Format format);

// For each row: 0 if it is up to date, else 1.
using RowFlags = std::span<const std::uint8_t>;

// Fill the rows of `plane` that `stale` names with the brightness of `screen`, or with the brighter of each
// two pixels. All screens and planes must have the same length, 160 times that of `stale`.
void make_plane(std::span<const std::uint8_t> screen, const Brightness& brightness, RowFlags stale,
                std::span<std::uint8_t> plane);
void make_brighter_plane(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                         const Brightness& brightness, RowFlags stale, std::span<std::uint8_t> plane);

// The ways to resize, each as OpenCV's INTER_AREA does: BlockMean if both sides shrink by whole numbers,
// AreaResize if neither side grows, otherwise Enlargement.
using ScreenResize = std::variant<BlockMean, AreaResize, Enlargement>;

// Returns the tables that resize a plane of 160 x height to this size. They are computed on first use, and
// the process shares them. Thread-safe. Throws std::invalid_argument for a size that none of them supports.
const ScreenResize& screen_resize(int height, int to_width, int to_height);

}  // namespace racebeam

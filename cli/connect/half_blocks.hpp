// A screen as text for a terminal with 24-bit colours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

// `screen` has rows of 160 pixels, as the line protocol's field screen, and `colours` has 256 x 3 bytes: red,
// green, blue. A cell of the terminal shows two pixels, one above the other. `columns`: the width of the
// picture, 1 to 160; its height keeps the proportions of a television, on which a pixel is twice as wide as
// high.
std::string half_blocks(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> colours,
                        std::size_t columns);

}  // namespace racebeam

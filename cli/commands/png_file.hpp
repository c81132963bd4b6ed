// A screen as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

// `rgb`: rows of 160 pixels, three bytes each. Every pixel is doubled horizontally, as the reference does: on
// a television they are nearly twice as wide as high (docs/spec/environment.md, 12). Throws
// std::runtime_error when the file can't be written.
void write_png(const std::string& path, std::span<const std::uint8_t> rgb);

}  // namespace racebeam

// Writes a screen as a PNG file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

// rgb: rows of 160 pixels, three bytes each. Every pixel is doubled horizontally, as in the reference: on a
// television, pixels are nearly twice as wide as high (docs/spec/environment.md, 12). Throws
// std::runtime_error if the file cannot be written.
void write_png(const std::string& path, std::span<const std::uint8_t> rgb);

}  // namespace racebeam

// Writes pictures as PNG files. All throw std::runtime_error if the file cannot be written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

// rgb: rows of `width` pixels, three bytes each.
void write_png(const std::string& path, std::span<const std::uint8_t> rgb, std::size_t width);

// rgb: rows of 160 pixels. Every pixel is doubled horizontally, as in the reference: on a television, pixels
// are nearly twice as wide as high (docs/spec/environment.md, 12).
void write_screen(const std::string& path, std::span<const std::uint8_t> rgb);

// bytes: of a PNG file.
void write_picture_file(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace racebeam

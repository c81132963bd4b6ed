// AVI as a stream, for other programs: uncompressed pictures of palette indices, and uncompressed sound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "recording/media.hpp"

namespace racebeam {

std::string avi_header(const Footage& footage);

// A picture of `height` rows, and the sound with it.
std::string avi_frame(std::span<const std::uint8_t> pixels, std::size_t height,
                      std::span<const std::uint8_t> samples);

}  // namespace racebeam

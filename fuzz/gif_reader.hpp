// A reader of GIF, so that what was written is read by something else.
#pragma once

#include <cstdint>
#include <vector>

#include "fuzz/target.hpp"

namespace racebeam::fuzz {

struct Gif {
  std::size_t width, height;
  std::vector<std::vector<std::uint8_t>> frames;
};

// Aborts, through require(), when `file` is none.
Gif read_gif(Bytes file);

// Image data: the size byte, blocks, and the empty one.
std::vector<std::uint8_t> unpack_lzw(Reader& reader);

}  // namespace racebeam::fuzz

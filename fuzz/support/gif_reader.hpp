// An independent reader of GIF, to check what was written.
#pragma once

#include <cstdint>
#include <vector>

#include "fuzz/support/target.hpp"

namespace racebeam::fuzz {

struct Gif {
  std::size_t width, height;
  std::vector<std::vector<std::uint8_t>> frames;
};

// Aborts, through require(), if `file` is not a GIF.
Gif read_gif(Bytes file);

// Reads image data: the size byte, blocks, and the empty block.
std::vector<std::uint8_t> unpack_lzw(Reader& reader);

}  // namespace racebeam::fuzz

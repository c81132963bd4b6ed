// The cartridge of tests/support/counter_image.hpp, whose header cannot be included beside the public ones.
#pragma once

#include <cstdint>
#include <vector>

namespace counter {

std::vector<std::uint8_t> bytes();

}  // namespace counter

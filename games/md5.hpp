// MD5, by which images are identified.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

std::string md5_of(std::span<const std::uint8_t> bytes);  // lower-case hex

}  // namespace racebeam

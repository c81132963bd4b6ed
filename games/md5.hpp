// MD5 (RFC 1321), by which images are identified.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

std::string md5_of(std::span<const std::uint8_t> bytes);  // in lower case

}  // namespace racebeam

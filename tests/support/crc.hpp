// CRC-32 as in PNG and zlib, for the checksums of the specification.
#pragma once

#include <cstdint>
#include <span>

namespace racebeam::test {

inline std::uint32_t crc(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int i = 0; i < 8; ++i) sum = sum >> 1 ^ (0xEDB88320 & (0u - (sum & 1)));
  }
  return ~sum;
}

}  // namespace racebeam::test

// The console's memory as a rule reads it, without side effects.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace racebeam {

constexpr std::size_t kRamBytes = 128;

// A part of the RAM: $FF for each byte that belongs to it.
using RamMask = std::array<std::uint8_t, kRamBytes>;

struct Memory {
  const std::uint8_t* ram = nullptr;  // the 128 bytes at $80-$FF
  // Reads any 13-bit address of `machine`, which is passed to it. May be null.
  std::uint8_t (*peek)(const void* machine, std::uint16_t address) = nullptr;
  const void* machine = nullptr;
};

}  // namespace racebeam

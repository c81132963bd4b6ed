// The console's memory as a rule reads it, without side effects.
#pragma once

#include <cstdint>

namespace racebeam {

struct Memory {
  const std::uint8_t* ram = nullptr;  // the 128 bytes at $80-$FF
  std::uint8_t (*peek)(const void* machine,
                       std::uint16_t address) = nullptr;  // any 13-bit address; may be null
  const void* machine = nullptr;                          // passed to peek
};

}  // namespace racebeam

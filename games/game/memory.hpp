// What a rule may look at: the console's memory, without any effect on it.
#pragma once

#include <cstdint>

namespace racebeam {

struct Memory {
  const std::uint8_t* ram = nullptr;  // the 128 bytes at $80-$FF
  std::uint8_t (*peek)(const void* machine,
                       std::uint16_t address) = nullptr;  // any 13-bit address; may be null
  const void* machine = nullptr;                          // handed to peek
};

}  // namespace racebeam

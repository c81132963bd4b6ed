// Values that translated code shares with the rest of the machine. Every Board has them at the same offset.
#pragma once

#include <cstdint>

namespace racebeam::translator {

struct Context {
  std::int32_t limit = 0;            // from this cycle on, the interpreter executes
  std::int32_t first_line = 0;       // cycle at which line 0 of the frame began, <= 0
  std::uint32_t waited = 0;          // cycles without instructions (WSYNC, skipped timer loops); wraps around
  std::uint32_t nz = 0;              // N is bit 15 or bit 7; Z is set when bits 7-0 are 0
  std::uint32_t carry = 0;           // 0 or 1
  std::uint8_t V = 0, D = 0, I = 0;  // 0 or 1
};

}  // namespace racebeam::translator

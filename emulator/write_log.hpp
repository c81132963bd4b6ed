// TIA accesses as data: the CPU appends, the TIA plays them when somebody looks (design: nothing ticks).
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

struct TiaAccess {
  std::int32_t cycle;
  std::uint8_t reg;  // $00-$2C; kTouch: draws up to its clock and changes nothing
  std::uint8_t value;
  std::uint16_t spare = 0;
};

constexpr std::uint8_t kTouch = 0x3F;

// One step's accesses. A step without a TIA write past the line limit has at most 343 lines of 76 cycles, and no
// instruction makes more than one access in two cycles, so that writes always fit; see has_room() for the reads.
struct WriteLog {
  static constexpr std::size_t kCapacity = 16384;

  std::size_t size = 0;
  std::array<TiaAccess, kCapacity> entry;

  void append(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    entry[size++] = {cycle, static_cast<std::uint8_t>(reg), value};
  }
  bool has_room() const { return size < kCapacity - 8; }
};

}  // namespace racebeam

// TIA accesses as data: the CPU appends, the TIA plays them when somebody looks (design: nothing ticks).
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {

// One word, so that it is written and compared as such.
class TiaAccess {
 public:
  TiaAccess() = default;
  TiaAccess(std::int32_t cycle, unsigned reg, std::uint8_t value)
      : packed_(static_cast<std::uint64_t>(cycle) << 16 | reg << 8 | value) {}

  std::int32_t cycle() const { return static_cast<std::int32_t>(packed_ >> 16); }
  unsigned reg() const { return packed_ >> 8 & 0xFF; }  // $00-$2C; kTouch: draws up to its clock, changes nothing
  std::uint8_t value() const { return static_cast<std::uint8_t>(packed_); }

  // Cycle from `first_cycle` on, register and value: what makes two lines the same.
  std::uint32_t since(std::int32_t first_cycle) const {
    return static_cast<std::uint32_t>(packed_ - (static_cast<std::uint64_t>(first_cycle) << 16));
  }

 private:
  std::uint64_t packed_;
};

constexpr std::uint8_t kTouch = 0x3F;

// One step's accesses. A step without a TIA write past the line limit has at most 343 lines of 76 cycles, and no
// instruction makes more than one access in two cycles, so that writes always fit; see has_room() for the reads.
struct WriteLog {
  static constexpr std::size_t kCapacity = 16384;

  std::size_t size = 0;
  std::array<TiaAccess, kCapacity> entry;

  void append(std::int32_t cycle, unsigned reg, std::uint8_t value) {
    entry[size++] = TiaAccess(cycle, reg, value);
  }
  bool has_room() const { return size < kCapacity - 8; }
};

}  // namespace racebeam

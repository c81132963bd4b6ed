// TiaRegisters in the processor's registers.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/base/vectors.hpp"
#include "emulator/state/state.hpp"

namespace racebeam {

struct RegisterVectors {
  std::array<TwoWords, 3> part;

  RACEBEAM_INLINE explicit RegisterVectors(const TiaRegisters& registers) { read(registers); }
  RACEBEAM_INLINE void read(const TiaRegisters& registers) {
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = of(registers, i);
  }
  RACEBEAM_INLINE void write(TiaRegisters& registers) const { registers = std::bit_cast<TiaRegisters>(part); }

  RACEBEAM_INLINE RegisterVectors& operator|=(const RegisterVectors& more) {
    for (std::size_t i = 0; i < part.size(); ++i) part[i] |= more.part[i];
    return *this;
  }
  RACEBEAM_INLINE RegisterVectors& operator&=(const RegisterVectors& mask) {
    for (std::size_t i = 0; i < part.size(); ++i) part[i] &= mask.part[i];
    return *this;
  }

  // Returns a bit for each byte of a mask of whole bytes.
  RACEBEAM_INLINE std::uint64_t bytes_set() const {
    return top_bits(part[0]) | std::uint64_t{top_bits(part[1])} << 16 |
           std::uint64_t{top_bits(part[2])} << 32;
  }

  // Returns a bit for each byte that differs.
  RACEBEAM_INLINE std::uint64_t bytes_other_than(const RegisterVectors& other) const {
    using Bytes [[gnu::vector_size(16)]] = char;
    std::uint64_t set = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto differ = reinterpret_cast<Bytes>(part[i]) != reinterpret_cast<Bytes>(other.part[i]);
      set |= std::uint64_t{top_bits(reinterpret_cast<TwoWords>(differ))} << 16 * i;
    }
    return set;
  }

  // A part of what lies in memory.
  RACEBEAM_INLINE static TwoWords of(const TiaRegisters& registers, std::size_t i) {
    return load<TwoWords>(reinterpret_cast<const std::uint8_t*>(&registers) + i * sizeof(TwoWords));
  }
};
static_assert(sizeof(RegisterVectors) == sizeof(TiaRegisters));

}  // namespace racebeam

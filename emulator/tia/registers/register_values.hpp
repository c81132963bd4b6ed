// The values of the TIA's registers and collision latches, as a program would write and read them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "emulator/state/state.hpp"
#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/sound.hpp"

namespace racebeam {

constexpr std::size_t kCollisionLatches = 8;  // registers of two latches each
constexpr std::size_t kTiaValues = kTiaRegisters + kCollisionLatches;

// The registers of registers.inc, then CXM0P to CXPPMM, each in the order of their addresses.
inline constexpr std::array<std::string_view, kTiaValues> kTiaValueNames = {
#define REGISTER(name, ...) #name,
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
    "CXM0P", "CXM1P", "CXP0FB", "CXP1FB", "CXM0FB", "CXM1FB", "CXBLPF", "CXPPMM"};

// In that order. Bits that the TIA does not keep are 0. RESP0 to RESBL have the position of their object, 0
// to 159; other registers that only trigger something have 0. The latches are in the bits 7 and 6.
std::array<std::uint8_t, kTiaValues> tia_values(const State& state, const Sound& sound);

}  // namespace racebeam

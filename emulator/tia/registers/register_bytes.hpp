// Which bytes of TiaRegisters a write sets and reads: the last columns of registers.inc as masks.
#pragma once

#include <array>

#include "emulator/state/tia_bytes.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam {

struct RegisterBytes {
  TiaRegisters sets, may_set, reads;
};

inline constexpr auto kRegisterBytes = [] {  // by address bits 5-0
  std::array<RegisterBytes, 64> table{};
#define REGISTER(name, use, delay, repeat, late, renews, bits, sets, may_set, reads) \
  table[name] = {RACEBEAM_TIA_BYTES(sets), RACEBEAM_TIA_BYTES(may_set), RACEBEAM_TIA_BYTES(reads)};
#include "emulator/tia/registers/registers.inc"
#undef REGISTER
  return table;
}();

}  // namespace racebeam

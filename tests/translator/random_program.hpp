// Random 6507 programs for the cartridge schemes: all opcodes, with operands at addresses with effects, in
// loops, subroutines, RAM, and across banks.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace racebeam::test {

struct Program {
  std::string_view scheme;
  std::vector<std::uint8_t> rom;
};

// Returns the same program for the same seed, on every machine.
Program make_program(std::uint32_t seed);

// The same for cartridges with an ARM, which `make_program` leaves out.
Program make_arm_program(std::uint32_t seed);

}  // namespace racebeam::test

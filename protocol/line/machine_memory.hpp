// The memory that a machine holds.
#pragma once

#include <cstddef>

#include "environment/vector/slot.hpp"

namespace racebeam {

// The most bytes of a machine whose objects do not flicker, without RAM on the cartridge and without a stack.
constexpr std::size_t kMaxMachineMemory = std::size_t{240} << 10;

// Bytes of a machine of `open` or `load`, with its stack.
std::size_t machine_memory(const Slot& slot);

}  // namespace racebeam

// The functions that translated code calls for accesses to anything but plain memory.
#pragma once

#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/translator/calling_convention.hpp"

namespace racebeam {
class Board;
}

namespace racebeam::translator::bus {

// Reads the TIA or the RIOT. latch: the value on the data bus before the read.
std::uint32_t RACEBEAM_SYSV_ABI read(Board* board, std::uint32_t address, std::uint32_t latch,
                                     std::int32_t cycle);

// Returns the cycle after the write.
std::int32_t RACEBEAM_SYSV_ABI write(Board* board, std::uint32_t address, std::uint32_t value,
                                     std::int32_t cycle);

// The read of PLA, wherever the stack pointer points.
std::uint32_t RACEBEAM_SYSV_ABI pull(Board* board, std::int32_t cycle);

// Returns V in bit 16, the carry in bit 8, and the sum or difference in bits 7-0.
std::uint32_t RACEBEAM_SYSV_ABI add_decimal(std::uint32_t a, std::uint32_t m, std::uint32_t carry,
                                            bool subtracts);

// Skips those iterations of a timer loop that are certain. `branch` points to the loop's branch, which has
// just been taken. Returns the cycle after the skipped iterations.
std::int32_t RACEBEAM_SYSV_ABI skip_timer_loop(Board* board, const std::uint8_t* branch, std::int32_t cycle,
                                               std::int32_t period);

#if defined(_WIN32)
// Calls a port reader by the compiler's calling convention.
std::uint32_t RACEBEAM_SYSV_ABI read_port(CartridgeSlot* slot, std::uint32_t address, std::int32_t cycle,
                                          PortReader reader);
#endif

}  // namespace racebeam::translator::bus

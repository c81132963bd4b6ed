// Calls from translated code into the machine, for accesses beyond plain memory. Each preserves the flags in
// r8d and r9d, and overwrites r10.
#pragma once

#include <cstdint>

#include "emulator/translator/assembler.hpp"

namespace racebeam::translator {

// Inputs: eax the address, in the TIA or the RIOT; ecx the data bus before; edx the cycle. Result: the byte
// in eax.
void call_read(Assembler& as);

// Input: edx the cycle. Result: the byte of the cartridge port in eax.
void call_port(Assembler& as, PortReader reader, std::uint16_t address);

// Inputs: eax the address; ecx the value; edx the cycle. Result: the cycle after the write in eax.
void call_write_bus(Assembler& as);

// PLA over the bus, wherever the stack pointer is. Input: edx the cycle. Result: the byte in eax.
void call_pull(Assembler& as);

// Decimal addition or subtraction. Inputs: al the operand; A in r12d, the carry in r9d. Results: A, the carry
// and V.
void call_decimal(Assembler& as, bool subtracts);

// Skips the iterations of a timer loop that are certain. `branch` points to the loop's branch, which has just
// been taken. Input and result: the cycle in ebp.
void call_skip_timer_loop(Assembler& as, const std::uint8_t* branch, int period);

// Writes the status byte, as PHP pushes it, into ecx. The flags come from r8d, r9d and memory. Only the
// host's flags and edx are overwritten besides.
void status_into_ecx(Assembler& as);

}  // namespace racebeam::translator

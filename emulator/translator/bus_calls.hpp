// Calls from translated code into the machine, for what is not plain memory. Each keeps the flags of r8d and r9d; r10 is
// lost.
#pragma once

#include <cstdint>

#include "emulator/translator/assembler.hpp"

namespace racebeam::translator {

// eax: address of the TIA or the RIOT; ecx: the data bus before; edx: cycle. Answers the byte in eax.
void call_read(Assembler& as);

// edx: cycle. Answers the byte of a port of the cartridge in eax.
void call_port(Assembler& as, PortReader reader, std::uint16_t address);

// eax: address; ecx: value; edx: cycle. Answers the cycle after it in eax.
void call_write_bus(Assembler& as);

// PLA over the bus, wherever the stack pointer is; edx: cycle. Answers the byte in eax.
void call_pull(Assembler& as);

// al: operand. Decimal addition or subtraction with A and carry in r12d and r9d; makes V too.
void call_decimal(Assembler& as, bool subtracts);

// Skips the turns of a timer loop that are certain, whose branch, at `branch`, has just been taken; cycle in ebp.
void call_skip_timer_loop(Assembler& as, const std::uint8_t* branch, int period);

// The status byte as PHP pushes it, into ecx; keeps all others but the host's flags. r8d and r9d are the flags.
void status_into_ecx(Assembler& as);

}  // namespace racebeam::translator

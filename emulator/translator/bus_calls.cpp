#include "emulator/translator/bus_calls.hpp"

#include "emulator/board/board.hpp"
#include "emulator/cpu/decimal.hpp"
#include "emulator/cpu/timer_loop.hpp"
#include "emulator/translator/calling_convention.hpp"

namespace racebeam::translator {
namespace {

std::uint32_t RACEBEAM_SYSV_ABI read_bus(Board* board, std::uint32_t address, std::uint32_t latch,
                                         std::int32_t cycle) {
  return board->read_device(static_cast<std::uint16_t>(address), static_cast<std::uint8_t>(latch), cycle);
}

std::int32_t RACEBEAM_SYSV_ABI write_bus(Board* board, std::uint32_t address, std::uint32_t value,
                                         std::int32_t cycle) {
  const auto byte = static_cast<std::uint8_t>(value);
  board->state.cpu.latch = byte;
  if ((address & 0x1080) == 0 && board->is_plain_write(static_cast<std::uint16_t>(address), cycle)) {
    board->log->append_change(cycle, address & 0x3F, byte);
    return cycle;
  }
  return board->write_device(static_cast<std::uint16_t>(address), byte, cycle, true);
}

std::uint32_t RACEBEAM_SYSV_ABI pull(Board* board, std::int32_t cycle) {
  constexpr std::uint8_t kOpcode = 0x68;
  CpuState& cpu = board->state.cpu;
  const auto read = [&](std::uint8_t sp, std::uint8_t latch) {
    return sp & 0x80 ? board->state.riot.ram[sp & 0x7F]
                     : board->read_device(static_cast<std::uint16_t>(0x100 | sp), latch, cycle);
  };
  const std::uint8_t unused = read(cpu.SP, kOpcode);
  return read(++cpu.SP, unused);
}

// Returns V in bit 16, the carry in bit 8, and the sum in bits 7-0.
std::uint32_t RACEBEAM_SYSV_ABI decimal(std::uint32_t a, std::uint32_t m, std::uint32_t carry,
                                        bool subtracts) {
  const auto left = static_cast<std::uint8_t>(a), right = static_cast<std::uint8_t>(m);
  const auto in = static_cast<std::uint8_t>(carry);
  const DecimalResult result = subtracts ? subtract_decimal(left, right, in) : add_decimal(left, right, in);
  const unsigned overflow = ((left ^ result.value) & (result.value ^ right)) >> 7 & 1U;
  return overflow << 16 | unsigned{result.carry} << 8 | result.value;
}

std::int32_t RACEBEAM_SYSV_ABI skip_timer_loop(Board* board, const std::uint8_t* branch, std::int32_t cycle,
                                               std::int32_t period) {
  const std::int32_t skipped = period * sure_timer_turns(branch, board->state.riot, cycle + 4, period);
  board->translated.waited += static_cast<std::uint32_t>(skipped);
  return cycle + skipped;
}

#if defined(_WIN32)
// Calls a reader by the compiler's convention.
std::uint32_t RACEBEAM_SYSV_ABI read_port(CartridgeSlot* slot, std::uint32_t address, std::int32_t cycle,
                                          PortReader reader) {
  return reader(*slot, static_cast<std::uint16_t>(address), cycle);
}
#endif

template <class Function>
void call(Assembler& as, Function* function) {
  as.mov(as.ptr[as.rsp], as.r8d);
  as.mov(as.ptr[as.rsp + 4], as.r9d);
  as.mov(as.rax, reinterpret_cast<std::uintptr_t>(function));
  as.call(as.rax);
  as.mov(as.r8d, as.ptr[as.rsp]);
  as.mov(as.r9d, as.ptr[as.rsp + 4]);
}

}  // namespace

void call_read(Assembler& as) {
  as.mov(as.rdi, as.rbx);
  as.mov(as.esi, as.eax);
  as.xchg(as.ecx, as.edx);
  call(as, read_bus);
}

void call_port(Assembler& as, PortReader reader, std::uint16_t address) {
  as.lea(as.rdi, as.ptr[as.rbx + as.layout.slot]);
  as.mov(as.esi, address);
#if defined(_WIN32)
  as.mov(as.rcx, reinterpret_cast<std::uintptr_t>(reader));
  call(as, read_port);
#else
  call(as, reader);
#endif
  as.movzx(as.eax, as.al);
}

void call_write_bus(Assembler& as) {
  as.mov(as.rdi, as.rbx);
  as.mov(as.esi, as.eax);
  as.xchg(as.ecx, as.edx);
  call(as, write_bus);
}

void call_pull(Assembler& as) {
  as.mov(as.rdi, as.rbx);
  as.mov(as.esi, as.edx);
  call(as, pull);
}

void call_decimal(Assembler& as, bool subtracts) {
  as.mov(as.edi, as.r12d);
  as.mov(as.esi, as.eax);
  as.mov(as.edx, as.r9d);
  as.mov(as.ecx, subtracts ? 1 : 0);
  call(as, decimal);
  as.movzx(as.r12d, as.al);
  as.shr(as.eax, 8);
  as.movzx(as.r9d, as.al);
  as.shr(as.eax, 8);
  as.mov(as.byte_of(as.layout.overflow), as.al);
}

void call_skip_timer_loop(Assembler& as, const std::uint8_t* branch, int period) {
  as.mov(as.rdi, as.rbx);
  as.mov(as.rsi, reinterpret_cast<std::uintptr_t>(branch));
  as.mov(as.edx, as.ebp);
  as.mov(as.ecx, period);
  call(as, skip_timer_loop);
  as.mov(as.ebp, as.eax);
}

// The bits are N V 1 1 D I Z C.
void status_into_ecx(Assembler& as) {
  const auto put = [&as](std::int32_t place, int bit) {
    as.movzx(as.edx, as.byte_of(place));
    as.shl(as.edx, bit);
    as.or_(as.ecx, as.edx);
  };
  as.xor_(as.ecx, as.ecx);
  as.test(as.r8b, as.r8b);
  as.setz(as.cl);
  as.add(as.ecx, as.ecx);
  as.xor_(as.edx, as.edx);
  as.test(as.r8d, 0x8080);
  as.setnz(as.dl);
  as.shl(as.edx, 7);
  as.or_(as.ecx, as.edx);
  as.or_(as.ecx, as.r9d);
  put(as.layout.overflow, 6);
  put(as.layout.decimal, 3);
  put(as.layout.interrupt, 2);
  as.or_(as.ecx, 0x30);
}

}  // namespace racebeam::translator

// Calls into the machine. They preserve r8d and r9d, and overwrite r10.
#include "emulator/translator/bus.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

template <class Function>
void x86_64::Processor::call(Function* function) {
  as_.mov(as_.ptr[as_.rsp], as_.r8d);
  as_.mov(as_.ptr[as_.rsp + 4], as_.r9d);
  as_.mov(as_.rax, reinterpret_cast<std::uintptr_t>(function));
  as_.call(as_.rax);
  as_.mov(as_.r8d, as_.ptr[as_.rsp]);
  as_.mov(as_.r9d, as_.ptr[as_.rsp + 4]);
  clobbered_flags();
}

void Host::read_bus(int cycles) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.call(as_.stubs.read_bus);
  clobbered_flags();
}

void Host::read_port(PortReader reader, std::uint16_t address, int cycles) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.lea(as_.rdi, as_.ptr[as_.rbx + as_.layout.slot]);
  as_.mov(as_.esi, address);
#if defined(_WIN32)
  as_.mov(as_.rcx, reinterpret_cast<std::uintptr_t>(reader));
  call(bus::read_port);
#else
  call(reader);
#endif
  as_.movzx(as_.eax, as_.al);
}

void Host::write_bus(int cycles, Label& leaves) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.mov(as_.rdi, as_.rbx);
  as_.mov(as_.esi, as_.eax);
  as_.xchg(as_.ecx, as_.edx);
  call(bus::write);
  as_.lea(as_.ebp, as_.ptr[as_.rax - cycles]);
  as_.cmp(as_.byte_of(as_.layout.stop), 0);
  as_.jne(leaves, kNear);
  as_.cmp(as_.word[as_.rbx + as_.layout.code_span], 0);
  as_.je(leaves, kNear);
}

void Host::pull_over_bus(int cycles) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.mov(as_.rdi, as_.rbx);
  as_.mov(as_.esi, as_.edx);
  call(bus::pull);
  as_.mov(as_.r12d, as_.eax);
}

void Host::add_decimal(bool subtracts, const Value& value, CarryHome carry) {
  into_al(value);
  if (carry != CarryHome::kNumber) make_carry(carry == CarryHome::kSet);
  as_.mov(as_.edi, as_.r12d);
  as_.mov(as_.esi, as_.eax);
  as_.mov(as_.edx, as_.r9d);
  as_.mov(as_.ecx, subtracts ? 1 : 0);
  call(bus::add_decimal);
  as_.movzx(as_.r12d, as_.al);
  as_.shr(as_.eax, 8);
  as_.movzx(as_.r9d, as_.al);
  as_.shr(as_.eax, 8);
  as_.mov(as_.byte_of(as_.layout.overflow), as_.al);
}

void Host::skip_timer_loop(const std::uint8_t* branch, int period) {
  as_.mov(as_.rdi, as_.rbx);
  as_.mov(as_.rsi, reinterpret_cast<std::uintptr_t>(branch));
  as_.mov(as_.edx, as_.ebp);
  as_.mov(as_.ecx, period);
  call(bus::skip_timer_loop);
  as_.mov(as_.ebp, as_.eax);
}

// The bits are N V 1 1 D I Z C.
void Host::load_status() {
  const auto put = [this](std::int32_t place, int bit) {
    as_.movzx(as_.edx, as_.byte_of(place));
    as_.shl(as_.edx, bit);
    as_.or_(as_.ecx, as_.edx);
  };
  as_.xor_(as_.ecx, as_.ecx);
  as_.test(as_.r8b, as_.r8b);
  as_.setz(as_.cl);
  as_.add(as_.ecx, as_.ecx);
  as_.xor_(as_.edx, as_.edx);
  as_.test(as_.r8d, 0x8080);
  as_.setnz(as_.dl);
  as_.shl(as_.edx, 7);
  as_.or_(as_.ecx, as_.edx);
  as_.or_(as_.ecx, as_.r9d);
  put(as_.layout.overflow, 6);
  put(as_.layout.decimal, 3);
  put(as_.layout.interrupt, 2);
  as_.or_(as_.ecx, 0x30);
}

}  // namespace racebeam::translator

// The stubs by which the emulator enters and leaves translated code, and by which that code reads the bus.
#include "emulator/translator/stubs.hpp"

#include <algorithm>
#include <iterator>

#include "emulator/translator/bus.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {
namespace {

using namespace Xbyak::util;

// Reads the device at the address in eax, with the latch in ecx, in the cycle in edx, into eax.
void emit_read_bus(Xbyak::CodeGenerator& as, const Layout& layout) {
  Xbyak::Label no_pin;
  as.mov(esi, eax);
  as.and_(esi, 0x1088);
  as.cmp(esi, 0x0008);
  as.jne(no_pin);
  as.and_(eax, 7);
  as.mov(dword[rbx + layout.last_access], edx);
  as.cmp(edx, dword[rbx + rax * 4 + layout.pins]);
  as.cmc();
  as.sbb(eax, eax);  // all bits set where the pin is high
  as.and_(eax, 0x80);
  as.and_(ecx, 0x3F);
  as.or_(eax, ecx);
  as.ret();
  as.L(no_pin);
  as.sub(rsp, 24);
  as.mov(dword[rsp], r8d);
  as.mov(dword[rsp + 4], r9d);
  as.mov(rdi, rbx);
  as.mov(esi, eax);
  as.xchg(ecx, edx);
  as.mov(rax, reinterpret_cast<std::uintptr_t>(bus::read));
  as.call(rax);
  as.mov(r8d, dword[rsp]);
  as.mov(r9d, dword[rsp + 4]);
  as.add(rsp, 24);
  as.ret();
}

}  // namespace

Stubs emit_stubs(void* memory, std::size_t size, const Layout& layout) {
  Xbyak::CodeGenerator as(size, memory);
  const Xbyak::Reg64 saved[] = {rbx, rbp, r12, r13, r14, r15};
  const auto in = [&](const Xbyak::Reg32& reg, std::int32_t place) { as.movzx(reg, byte[rbx + place]); };
  const auto out = [&](const Xbyak::Reg8& reg, std::int32_t place) { as.mov(byte[rbx + place], reg); };
  const void* enter = as.getCurr();
  for (const auto& reg : saved) as.push(reg);
  as.sub(rsp, 24);
  as.mov(rbx, rsi);
  as.mov(r15, rdx);
  in(r12d, layout.a), in(r13d, layout.x), in(r14d, layout.y);
  as.mov(ebp, dword[rbx + layout.cycle]);
  as.mov(r8d, dword[rbx + layout.nz]);
  as.mov(r9d, dword[rbx + layout.carry]);
  as.jmp(rdi);
  const void* leave = as.getCurr();
  out(r12b, layout.a), out(r13b, layout.x), out(r14b, layout.y);
  as.mov(dword[rbx + layout.cycle], ebp);
  as.mov(dword[rbx + layout.nz], r8d);
  as.mov(dword[rbx + layout.carry], r9d);
  as.add(rsp, 24);
  std::for_each(std::rbegin(saved), std::rend(saved), [&](const auto& reg) { as.pop(reg); });
  as.ret();
  const void* read_bus = as.getCurr();
  emit_read_bus(as, layout);
  return {enter, leave, read_bus, as.getSize()};
}

}  // namespace racebeam::translator

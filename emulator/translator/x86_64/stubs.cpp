// The stubs by which the emulator enters and leaves translated code.
#include <algorithm>
#include <iterator>

#include "emulator/translator/host.hpp"

namespace racebeam::translator {

Stubs emit_stubs(void* memory, std::size_t size, const Layout& layout) {
  using namespace Xbyak::util;
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
  return {enter, leave, as.getSize()};
}

}  // namespace racebeam::translator

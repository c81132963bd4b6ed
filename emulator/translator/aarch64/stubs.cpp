// The stubs by which the emulator enters and leaves translated code, and by which that code reads the bus.
#include "emulator/translator/stubs.hpp"

#include "emulator/translator/bus.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

namespace {

// Reads the device at kAddress into kByte, with kLatch, in the cycle kTime.
void emit_read_bus(Encoder& as, const Layout& layout) {
  Label no_pin;
  as.mov(kScratch, 0x1088U);
  as.and_(kScratch, kAddress, kScratch);
  as.cmp(kScratch, 0x0008U);
  as.b(Condition::ne, no_pin);
  as.str(kTime, kBoard, layout.last_access);
  as.and_(kAddress, kAddress, 7U);
  as.add(kPlace, kBoard, x(kAddress.number), 2);
  as.ldr(kScratch, kPlace, layout.pins);
  as.cmp(kTime, kScratch);
  as.cset(kByte, Condition::hs);
  as.and_(kLatch, kLatch, 0x3FU);
  as.orr(kByte, kLatch, kByte, 7);
  as.ret();
  as.bind(no_pin);
  as.mov(x(0), kBoard);
  as.mov(kPointer, reinterpret_cast<std::uintptr_t>(bus::read));
  as.br(kPointer);
}

}  // namespace

Stubs emit_stubs(void* memory, std::size_t size, const Layout& layout) {
  constexpr int kFrame = 96;
  Encoder as(memory, size);
  const void* enter = as.here();
  as.stp_pre(x(29), x(30), sp, -kFrame);
  for (unsigned i = 0; i < 5; ++i) as.stp(x(19 + 2 * i), x(20 + 2 * i), sp, static_cast<int>(16 + 16 * i));
  as.mov(kBoard, x(1));
  as.mov(kLog, x(2));
  as.ldrb(kA, kBoard, layout.a);
  as.ldrb(kX, kBoard, layout.x);
  as.ldrb(kY, kBoard, layout.y);
  as.ldr(kCycle, kBoard, layout.cycle);
  as.ldr(kNz, kBoard, layout.nz);
  as.ldr(kCarry, kBoard, layout.carry);
  as.ldr(kLimit, kBoard, layout.limit);
  as.ldr(kRom, kBoard, layout.code);
  as.br(x(0));
  const void* leave = as.here();
  as.strb(kA, kBoard, layout.a);
  as.strb(kX, kBoard, layout.x);
  as.strb(kY, kBoard, layout.y);
  as.str(kCycle, kBoard, layout.cycle);
  as.str(kNz, kBoard, layout.nz);
  as.str(kCarry, kBoard, layout.carry);
  for (unsigned i = 0; i < 5; ++i) as.ldp(x(19 + 2 * i), x(20 + 2 * i), sp, static_cast<int>(16 + 16 * i));
  as.ldp_post(x(29), x(30), sp, kFrame);
  as.ret();
  const void* read_bus = as.here();
  emit_read_bus(as, layout);
  return {enter, leave, read_bus, as.size()};
}

}  // namespace racebeam::translator

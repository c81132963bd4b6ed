// Calls into the machine. They preserve all registers that hold the 6507's state.
#include "emulator/translator/bus.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

namespace {

constexpr Register kArguments[] = {x(0), x(1), x(2), x(3)};

}  // namespace

template <class Function>
void aarch64::Processor::call(Function* function) {
  as_.mov(kPointer, reinterpret_cast<std::uintptr_t>(function));
  as_.blr(kPointer);
}

void Host::read_bus(int cycles) {
  add_constant(kTime, kCycle, cycles);
  as_.bl(as_.stubs.read_bus);
}

void Host::read_port(PortReader reader, std::uint16_t address, int cycles) {
  as_.add(kArguments[0], kBoard, static_cast<unsigned>(as_.layout.slot));
  as_.mov(w(1), unsigned{address});
  add_constant(w(2), kCycle, cycles);
  call(reader);
  keep_byte(kByte);
}

void Host::write_bus(int cycles, Label& leaves) {
  as_.mov(kArguments[0], kBoard);
  add_constant(kTime, kCycle, cycles);
  call(bus::write);
  add_constant(kCycle, w(0), -cycles);
  as_.ldrb(kScratch, kBoard, as_.layout.stop);
  as_.cbnz(kScratch, leaves);
  as_.ldrh(kScratch, kBoard, as_.layout.code_span);
  as_.cbz(kScratch, leaves);
}

void Host::pull_over_bus(int cycles) {
  as_.mov(kArguments[0], kBoard);
  add_constant(w(1), kCycle, cycles);
  call(bus::pull);
  as_.mov(kA, w(0));
}

void Host::add_decimal(bool subtracts, const Value& value, CarryHome carry) {
  as_.mov(w(1), operand(value));
  as_.mov(w(0), kA);
  if (carry == CarryHome::kNumber)
    as_.mov(w(2), kCarry);
  else
    as_.mov(w(2), carry == CarryHome::kSet ? 1U : 0U);
  as_.mov(w(3), subtracts ? 1U : 0U);
  call(bus::add_decimal);
  as_.and_(kA, w(0), 0xFFU);
  as_.ubfx(kCarry, w(0), 8, 1);
  as_.lsr(kScratch, w(0), 16);
  as_.strb(kScratch, kBoard, as_.layout.overflow);
}

void Host::skip_timer_loop(const std::uint8_t* branch, int period) {
  as_.mov(kArguments[0], kBoard);
  as_.mov(kArguments[1], reinterpret_cast<std::uintptr_t>(branch));
  as_.mov(w(2), kCycle);
  as_.mov(w(3), static_cast<unsigned>(period));
  call(bus::skip_timer_loop);
  as_.mov(kCycle, w(0));
}

}  // namespace racebeam::translator

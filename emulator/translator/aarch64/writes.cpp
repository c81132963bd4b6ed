// Writes: to RAM, to the write log, and to the sound's registers.
#include <cstddef>

#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

namespace {

constexpr int place_of_written(unsigned reg) {
  return static_cast<int>(offsetof(WriteLog, written) + 2 * reg);
}

}  // namespace

void Host::write_ram(unsigned offset, Reg value) {
  as_.strb(reg_of(value), kBoard, as_.layout.ram + static_cast<int>(offset));
}

void Host::write_ram_at_offset(Reg value) {
  ram_at(kOffset);
  as_.strb(reg_of(value), kPlace, as_.layout.ram);
}

void Host::write_ram_at_address(Reg value, Label& device) {
  compare_with_ram(kAddress);
  as_.b(Condition::ne, device);
  as_.and_(kOffset, kAddress, 0x7FU);
  write_ram_at_offset(value);
}

void Host::latch_value(Reg value) { as_.mov(kLatch, reg_of(value)); }

void Host::touch_tia(int cycles) {
  add_constant(kTime, kCycle, cycles);
  as_.str(kTime, kBoard, as_.layout.last_access);
}

void Host::write_sound(unsigned reg, Reg value) {
  as_.strb(reg_of(value), kBoard, as_.layout.sound + static_cast<int>(reg - AUDC0));
}

void Host::forget_motion() {
  as_.mov(kScratch, unsigned{WriteLog::kUnknown});
  for (const unsigned reg : {HMP0, HMP1, HMM0, HMM1, HMBL}) as_.strh(kScratch, kLog, place_of_written(reg));
}

// The register with the value as it is logged: `scratch`, if bits are left out.
Register Processor::logged_value(unsigned reg, Reg value, Register scratch) {
  if (logged_bits(reg) == 0xFF) return reg_of(value);
  as_.mov(scratch, unsigned{logged_bits(reg)});
  as_.and_(scratch, scratch, reg_of(value));
  return scratch;
}

void Host::append_change(unsigned reg, Reg value, int cycles) {
  const Register byte = logged_value(reg, value, kTime);
  Label repeated;
  if (WriteLog::kOnRepeat[reg] == 0) {
    as_.ldrh(kScratch, kLog, place_of_written(reg));
    as_.cmp(kScratch, byte);
    as_.b(Condition::eq, repeated);
    as_.strh(byte, kLog, place_of_written(reg));
    if (const unsigned other = kRegisters[reg].renews; other != kNone) {
      Label same_value;
      as_.and_(kScratch, kScratch, WriteLog::kUnknown | 0xFFU);
      as_.cmp(kScratch, byte);
      as_.b(Condition::eq, same_value);
      as_.ldrh(kScratch, kLog, place_of_written(other));
      as_.orr(kScratch, kScratch, unsigned{WriteLog::kUnsettled});
      as_.strh(kScratch, kLog, place_of_written(other));
      as_.bind(same_value);
    }
  }
  append(reg, value, cycles);
  as_.bind(repeated);
}

// Appends cycle, register and value, as a TiaWrite.
void Host::append(unsigned reg, Reg value, int cycles) {
  as_.ldr(kScratch, kLog, static_cast<int>(offsetof(WriteLog, base)));
  as_.sub(kTime, kCycle, kScratch);
  add_constant(kTime, kTime, cycles);
  if (logged_bits(reg) == 0)
    as_.lsl(kTime, kTime, TiaWrite::kCycleShift);
  else
    as_.orr(kTime, logged_value(reg, value, kOther), kTime, TiaWrite::kCycleShift);
  add_constant(kTime, kTime, static_cast<int>(reg << 8));
  as_.ldr(kPlace, kLog, static_cast<int>(offsetof(WriteLog, next)));
  as_.str_post(kTime, kPlace, sizeof(std::uint32_t));
  as_.str(kPlace, kLog, static_cast<int>(offsetof(WriteLog, next)));
}

// Divides by 76, which is exact for cycles below 69,000. The limit is far below that.
void Host::wait_for_line(int cycles) {
  const Register line = kTarget;
  as_.ldr(kOther, kBoard, as_.layout.first_line);
  add_constant(line, kCycle, cycles + 75);
  as_.sub(line, line, kOther);
  as_.mov(kScratch, 55189U);
  as_.madd(line, line, kScratch, wzr);
  as_.lsr(line, line, 22);
  as_.mov(kScratch, 76U);
  touch_tia(cycles);
  as_.madd(kCycle, line, kScratch, kOther);
  as_.sub(kTime, kCycle, kTime);
  as_.ldr(kScratch, kBoard, as_.layout.waited);
  as_.add(kScratch, kScratch, kTime);
  as_.str(kScratch, kBoard, as_.layout.waited);
}

}  // namespace racebeam::translator

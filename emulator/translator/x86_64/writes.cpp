// Writes: to RAM, to the write log, and to the sound's registers.
#include <cstddef>

#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam::translator {
namespace {

constexpr int place_of_written(unsigned reg) {
  return static_cast<int>(offsetof(WriteLog, written) + 2 * reg);
}

}  // namespace

void Host::write_ram(unsigned offset, Reg value) { as_.mov(as_.byte[ram(offset)], reg_of(value).cvt8()); }

void Host::write_ram_at_offset(Reg value) {
  as_.mov(as_.byte[as_.rbx + as_.rcx + as_.layout.ram], reg_of(value).cvt8());
}

void Host::write_ram_at_address(Reg value, Label& device) {
  as_.mov(as_.ecx, as_.eax);
  as_.and_(as_.ecx, 0x1280);
  as_.cmp(as_.ecx, 0x80);
  as_.jne(device, kNear);
  as_.and_(as_.eax, 0x7F);
  as_.mov(as_.byte[as_.rbx + as_.rax + as_.layout.ram], reg_of(value).cvt8());
  clobbered_flags();
}

void Host::latch_value(Reg value) { as_.mov(as_.ecx, reg_of(value)); }

// Leaves the cycle of the access in edx.
void Host::touch_tia(int cycles) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.mov(as_.dword_of(as_.layout.last_access), as_.edx);
}

void Host::write_sound(unsigned reg, Reg value) {
  as_.mov(as_.byte_of(as_.layout.sound + static_cast<int>(reg - AUDC0)), reg_of(value).cvt8());
}

void Host::forget_motion() {
  static_assert(HMP1 == HMP0 + 1 && HMM0 == HMP0 + 2 && HMM1 == HMP0 + 3 && HMBL == HMP0 + 4);
  constexpr int kFirst = place_of_written(HMP0);
  for (const int at : {0, 4})
    as_.mov(as_.dword[as_.r15 + (kFirst + at)], WriteLog::kUnknown << 16 | WriteLog::kUnknown);
  as_.mov(as_.word[as_.r15 + (kFirst + 8)], WriteLog::kUnknown);
}

// The register with the value as it is logged: `scratch`, if bits are left out.
Xbyak::Reg32 x86_64::Processor::logged_value(unsigned reg, Reg value, Reg32 scratch) {
  if (logged_bits(reg) == 0xFF) return reg_of(value);
  as_.mov(scratch, reg_of(value));
  as_.and_(scratch, logged_bits(reg));
  return scratch;
}

void Host::append_change(unsigned reg, Reg value, int cycles) {
  Label repeated;
  if (WriteLog::kOnRepeat[reg] == 0) {
    const Xbyak::Reg32 logged = logged_value(reg, value, as_.ecx);
    const auto before = as_.word[as_.r15 + place_of_written(reg)];
    const unsigned other = kRegisters[reg].renews;
    if (other != kNone) as_.movzx(as_.edx, before);
    as_.cmp(before, logged.cvt16());
    as_.je(repeated);
    as_.mov(before, logged.cvt16());
    if (other != kNone) {
      Label same_value;
      as_.and_(as_.edx, WriteLog::kUnknown | 0xFF);
      as_.cmp(as_.edx, logged);
      as_.je(same_value);
      // This accesses a whole word: after a store of one of its bytes, the next load of the word would stall.
      as_.or_(as_.word[as_.r15 + place_of_written(other)], WriteLog::kUnsettled);
      as_.L(same_value);
    }
  }
  append(reg, value, cycles);
  as_.L(repeated);
}

// Appends cycle, register and value, as a TiaWrite.
void Host::append(unsigned reg, Reg value, int cycles) {
  as_.lea(as_.ecx, as_.ptr[as_.rbp + cycles]);
  as_.sub(as_.ecx, as_.dword[as_.r15 + offsetof(WriteLog, base)]);
  as_.shl(as_.ecx, TiaWrite::kCycleShift);
  if (logged_bits(reg) == 0)
    as_.add(as_.ecx, reg << 8);
  else
    as_.lea(as_.ecx,
            as_.ptr[as_.rcx + logged_value(reg, value, as_.edx).cvt64() + static_cast<int>(reg << 8)]);
  as_.mov(as_.rdx, as_.ptr[as_.r15 + offsetof(WriteLog, next)]);
  as_.mov(as_.ptr[as_.rdx], as_.ecx);
  as_.add(as_.qword[as_.r15 + offsetof(WriteLog, next)], sizeof(std::uint32_t));
  clobbered_flags();
}

// Divides by 76, which is exact for cycles below 69,000. The limit is far below that.
void Host::wait_for_line(int cycles) {
  as_.mov(as_.ecx, as_.dword_of(as_.layout.first_line));
  as_.lea(as_.eax, as_.ptr[as_.rbp + (cycles + 75)]);
  as_.sub(as_.eax, as_.ecx);
  as_.imul(as_.eax, as_.eax, 55189);
  as_.shr(as_.eax, 22);
  as_.imul(as_.eax, as_.eax, 76);
  as_.add(as_.eax, as_.ecx);
  touch_tia(cycles);
  as_.mov(as_.ebp, as_.eax);
  as_.sub(as_.eax, as_.edx);
  as_.add(as_.dword_of(as_.layout.waited), as_.eax);
  clobbered_flags();
}

}  // namespace racebeam::translator

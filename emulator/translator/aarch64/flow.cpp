// Jumps, branches, and the flags that they test.
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

void aarch64::Processor::add_constant(Register to, Register from, int value) {
  const auto size = static_cast<unsigned>(value < 0 ? -value : value);
  if (!Encoder::is_immediate(size)) {
    as_.mov(kScratch, size);
    if (value < 0)
      as_.sub(to, from, kScratch);
    else
      as_.add(to, from, kScratch);
  } else if (value < 0) {
    as_.sub(to, from, size);
  } else {
    as_.add(to, from, size);
  }
}

void aarch64::Processor::compare_with(Register reg, unsigned value) {
  if (Encoder::is_immediate(value)) return as_.cmp(reg, value);
  as_.mov(kScratch, value);
  as_.cmp(reg, kScratch);
}

void Host::bind(Label& label) { as_.bind(label); }
void Host::jump(Label& label) { as_.b(label); }
void Host::jump(const void* code) { as_.b(code); }

void Host::jump_through(const void* const* entry, Label& none) {
  as_.mov(kPointer, reinterpret_cast<std::uintptr_t>(entry));
  as_.ldr(kBlock, kPointer, 0);
  as_.cbz(kBlock, none);
  as_.br(kBlock);
}

void Host::jump_at_limit(Label& reached, Distance) {
  as_.cmp(kCycle, kLimit);
  as_.b(Condition::ge, reached);
}

void Host::leave(std::uint32_t exit) {
  as_.mov(kByte, exit);
  as_.b(as_.stubs.leave);
}

void Host::add_cycles(int cycles) { add_constant(kCycle, kCycle, cycles); }

void Host::make_nz(NzHome home) {
  if (home == NzHome::kNumber) return;
  as_.mov(kNz, reg_of(static_cast<Reg>(home)));
  nz_form_ = NzForm::kPlain;
}

void Host::make_carry(bool set) { as_.mov(kCarry, set ? 1U : 0U); }

void aarch64::Processor::branch_on_sign(NzHome home, bool if_set, Label& taken) {
  Register reg = home == NzHome::kNumber ? kNz : reg_of(static_cast<Reg>(home));
  unsigned bit = 7;
  if (home == NzHome::kNumber && nz_form_ == NzForm::kWord) bit = 15;
  if (home == NzHome::kNumber && nz_form_ == NzForm::kAny) {
    as_.orr_lsr(kScratch, kNz, kNz, 8);
    reg = kScratch;
  }
  if (if_set)
    as_.tbnz(reg, bit, taken);
  else
    as_.tbz(reg, bit, taken);
}

void aarch64::Processor::branch_on_zero(NzHome home, bool if_set, Label& taken) {
  Register reg = home == NzHome::kNumber ? kNz : reg_of(static_cast<Reg>(home));
  if (home == NzHome::kNumber && nz_form_ != NzForm::kPlain) {
    as_.and_(kScratch, kNz, 0xFFU);
    reg = kScratch;
  }
  if (if_set)
    as_.cbz(reg, taken);
  else
    as_.cbnz(reg, taken);
}

void Host::branch(Operation operation, NzHome nz, Label& taken) {
  switch (operation) {
    case Operation::bpl: branch_on_sign(nz, false, taken); break;
    case Operation::bmi: branch_on_sign(nz, true, taken); break;
    case Operation::bne: branch_on_zero(nz, false, taken); break;
    case Operation::beq: branch_on_zero(nz, true, taken); break;
    case Operation::bvc:
      as_.ldrb(kScratch, kBoard, as_.layout.overflow);
      as_.cbz(kScratch, taken);
      break;
    case Operation::bvs:
      as_.ldrb(kScratch, kBoard, as_.layout.overflow);
      as_.cbnz(kScratch, taken);
      break;
    case Operation::bcs: as_.cbnz(kCarry, taken); break;
    default: as_.cbz(kCarry, taken); break;
  }
}

// The low byte is at the lower address, since the stack grows down.
void Host::push_return_address(std::uint16_t address, Label& outside) {
  as_.ldrb(kOffset, kBoard, as_.layout.sp);
  as_.cmp(kOffset, 0x81U);
  as_.b(Condition::lo, outside);
  as_.mov(kScratch, unsigned{address});
  ram_at(kOffset);
  as_.strh(kScratch, kPlace, as_.layout.ram - 0x81);
  as_.sub(kOffset, kOffset, 2U);
  as_.strb(kOffset, kBoard, as_.layout.sp);
}

// Leaves the stack pointer in kOffset, the address before the target in kAddress, and the block's offset in
// kTarget.
void Host::load_return_address(Label& interpret) {
  as_.ldrb(kOffset, kBoard, as_.layout.sp);
  as_.sub(kScratch, kOffset, 0x7FU);
  as_.cmp(kScratch, 0x7EU);
  as_.b(Condition::hi, interpret);
  ram_at(kOffset);
  as_.ldrh(kAddress, kPlace, as_.layout.ram - 0x7F);
  add_constant(kTarget, kAddress, 1 - as_.window.code.first);
  as_.cbz(kTarget, interpret);  // The CPU also reads the byte before the target.
}

void Host::drop_return_address() {
  as_.add(kScratch, kOffset, 2U);
  as_.strb(kScratch, kBoard, as_.layout.sp);
}

void Host::load_jump_address(unsigned pointer) {
  as_.ldrh(kAddress, kBoard, as_.layout.ram + static_cast<int>(pointer & 0x7F));
  add_constant(kTarget, kAddress, -as_.window.code.first);
}

void Host::find_block(Label& none) {
  compare_with(kTarget, as_.window.code.span);
  as_.b(Condition::hs, none);
  as_.mov(kPointer, reinterpret_cast<std::uintptr_t>(as_.window.entries));
  as_.ldr_lsl3(kBlock, kPointer, kTarget);
  as_.cbz(kBlock, none);
  jump_at_limit(none, Distance::kNear);
}

void Host::jump_to_found_block(int cycles) {
  add_cycles(cycles);
  as_.br(kBlock);
}

void Host::leave_to_return_address(int cycles, Label& interpret) {
  as_.ubfx(kScratch, kAddress, 6, 8);
  as_.add(kPlace, kBoard, x(kScratch.number), 3);
  as_.ldr(kPage, kPlace, as_.layout.pages);
  as_.cbz(kPage, interpret);
  as_.add(kTarget, kAddress, 1U);
  as_.and_(kScratch, kAddress, kTarget);
  as_.tbz(kScratch, 12, interpret);
  drop_return_address();
  add_cycles(cycles);
  as_.ubfx(kByte, kTarget, 0, 16);
  as_.b(as_.stubs.leave);
}

}  // namespace racebeam::translator

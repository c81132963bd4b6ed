// Registers, flags and the stack.
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

using namespace aarch64;

Register aarch64::Processor::operand(const Value& value) {
  const int number = static_cast<int>(value.number);
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(kScratch, value.number); break;
    case Value::Kind::kRam: as_.ldrb(kScratch, kBoard, as_.layout.ram + number); break;
    case Value::Kind::kPage: as_.ldrb(kScratch, kPage, number); break;
    case Value::Kind::kTable:
      add_constant(kOther, reg_of(value.index), number);
      as_.ldrb(kScratch, kRom, kOther);
      break;
    case Value::Kind::kByte: return kByte;
  }
  return kScratch;
}

void aarch64::Processor::ram_at(Register index) { as_.add(kPlace, kBoard, x(index.number)); }

void Host::load(Reg to, const Value& value) {
  const Register reg = reg_of(to);
  const int number = static_cast<int>(value.number);
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(reg, value.number); break;
    case Value::Kind::kRam: as_.ldrb(reg, kBoard, as_.layout.ram + number); break;
    case Value::Kind::kPage: as_.ldrb(reg, kPage, number); break;
    case Value::Kind::kTable:
      add_constant(kOther, reg_of(value.index), number);
      as_.ldrb(reg, kRom, kOther);
      break;
    case Value::Kind::kByte: as_.mov(reg, kByte); break;
  }
}

void Host::logic(Operation operation, const Value& value) {
  const Register other = operand(value);
  switch (operation) {
    case Operation::and_: as_.and_(kA, kA, other); break;
    case Operation::ora: as_.orr(kA, kA, other); break;
    default: as_.eor(kA, kA, other); break;
  }
}

// Subtraction adds the operand's complement. The sum has nine bits; the highest is the carry.
void Host::add(bool subtracts, const Value& value, CarryHome carry, Flags live, Label& decimal) {
  as_.ldrb(kScratch, kBoard, as_.layout.decimal);
  as_.cbnz(kScratch, decimal);
  Register other = operand(value);
  if (subtracts) {
    as_.eor(kScratch, other, 0xFFU);
    other = kScratch;
  }
  as_.add(kOther, kA, other);
  if (carry == CarryHome::kNumber) as_.add(kOther, kOther, kCarry);
  if (carry == CarryHome::kSet) as_.add(kOther, kOther, 1U);
  if (live.v) {  // set if both operands have a sign that differs from the sum's
    as_.eor(kOffset, kOther, kA);
    as_.eor(kScratch, kOther, other);
    as_.and_(kScratch, kScratch, kOffset);
    as_.ubfx(kScratch, kScratch, 7, 1);
    as_.strb(kScratch, kBoard, as_.layout.overflow);
  }
  as_.and_(kA, kOther, 0xFFU);
  as_.lsr(kCarry, kOther, 8);
}

void Host::compare(Reg reg, const Value& value, Flags live) {
  if (value.kind == Value::Kind::kConstant)
    as_.subs(kScratch, reg_of(reg), value.number);
  else
    as_.subs(kScratch, reg_of(reg), operand(value));
  if (live.c) as_.cset(kCarry, Condition::hs);
  if (!live.nz) return;
  as_.and_(kNz, kScratch, 0xFFU);
  nz_form_ = NzForm::kPlain;
}

// N and V are bits of the operand. Z is set if the operand and A have no set bit in common.
void Host::bit(const Value& value, Flags live) {
  const Register other = operand(value);
  if (live.nz) {
    as_.and_(kNz, kA, other);
    as_.and_(kOther, other, 0x80U);
    as_.orr(kNz, kNz, kOther, 8);
    nz_form_ = NzForm::kWord;
  }
  if (live.v) {
    as_.ubfx(kScratch, other, 6, 1);
    as_.strb(kScratch, kBoard, as_.layout.overflow);
  }
}

void Host::transfer(Reg to, Reg from) { as_.mov(reg_of(to), reg_of(from)); }

void Host::step(Reg reg, int by) {
  add_constant(reg_of(reg), reg_of(reg), by);
  keep_byte(reg_of(reg));
}

void Host::carry_became_known() {}
void Host::forget_nz() { nz_form_ = NzForm::kAny; }

void Host::store(std::int32_t place, std::uint8_t byte) {
  if (byte != 0) as_.mov(kScratch, unsigned{byte});
  as_.strb(byte != 0 ? kScratch : wzr, kBoard, place);
}

void Host::transfer_sp_to_x() { as_.ldrb(kX, kBoard, as_.layout.sp); }
void Host::transfer_x_to_sp() { as_.strb(kX, kBoard, as_.layout.sp); }
void Host::load_sp() { as_.ldrb(kAddress, kBoard, as_.layout.sp); }

// The bits are N V 1 1 D I Z C.
void Host::load_status() {
  as_.tst(kNz, 0xFFU);
  as_.cset(kLatch, Condition::eq);
  as_.orr(kLatch, kCarry, kLatch, 1);
  as_.orr_lsr(kScratch, kNz, kNz, 8);
  as_.and_(kScratch, kScratch, 0x80U);
  as_.orr(kLatch, kLatch, kScratch);
  const auto put = [this](std::int32_t place, unsigned bit) {
    as_.ldrb(kScratch, kBoard, place);
    as_.orr(kLatch, kLatch, kScratch, bit);
  };
  put(as_.layout.overflow, 6);
  put(as_.layout.decimal, 3);
  put(as_.layout.interrupt, 2);
  as_.orr(kLatch, kLatch, 0x30U);
}

void Host::push(bool status, Label& device) {
  as_.tbz(kAddress, 7, device);
  ram_at(kAddress);
  as_.strb(status ? kLatch : kA, kPlace, as_.layout.ram - 0x80);
  as_.sub(kScratch, kAddress, 1U);
  as_.strb(kScratch, kBoard, as_.layout.sp);
}

void Host::push_to_device(bool status) {
  as_.sub(kScratch, kAddress, 1U);
  as_.strb(kScratch, kBoard, as_.layout.sp);
  as_.orr(kAddress, kAddress, 0x100U);
  if (!status) as_.mov(kLatch, kA);
}

// Reads the byte above the stack pointer.
void Host::pull(Label& outside) {
  load_sp();
  as_.sub(kScratch, kAddress, 0x80U);
  as_.cmp(kScratch, 0x7FU);
  as_.b(Condition::hs, outside);
  ram_at(kAddress);
  as_.ldrb(kA, kPlace, as_.layout.ram - 0x7F);
  as_.add(kAddress, kAddress, 1U);
  as_.strb(kAddress, kBoard, as_.layout.sp);
}

void aarch64::Processor::shift(Operation operation, Register reg, CarryHome carry, Flags live) {
  switch (operation) {
    case Operation::asl:
      if (live.c) as_.lsr(kCarry, reg, 7);
      as_.ubfiz(reg, reg, 1, 7);
      break;
    case Operation::lsr:
      if (live.c) as_.and_(kCarry, reg, 1U);
      as_.lsr(reg, reg, 1);
      break;
    default: rotate(operation, reg, carry, live); break;
  }
}

// Rotates nine bits: the register's eight and the carry.
void aarch64::Processor::rotate(Operation operation, Register reg, CarryHome carry, Flags live) {
  const bool left = operation == Operation::rol;
  if (carry != CarryHome::kNumber) as_.mov(kCarry, carry == CarryHome::kSet ? 1U : 0U);
  if (left)
    as_.orr(kOther, kCarry, reg, 1);
  else
    as_.orr(kOther, reg, kCarry, 8);
  if (left) {
    if (live.c) as_.lsr(kCarry, kOther, 8);
    as_.and_(reg, kOther, 0xFFU);
  } else {
    if (live.c) as_.and_(kCarry, kOther, 1U);
    as_.lsr(reg, kOther, 1);
  }
}

void aarch64::Processor::modify(Register base, int offset, Operation operation, CarryHome carry, Flags live) {
  const Register byte = live.nz ? kNz : kByte;
  as_.ldrb(byte, base, offset);
  if (operation == Operation::inc || operation == Operation::dec) {
    add_constant(byte, byte, operation == Operation::inc ? 1 : -1);
    if (live.nz) keep_byte(byte);
  } else {
    shift(operation, byte, carry, live);
  }
  as_.strb(byte, base, offset);
  if (live.nz) nz_form_ = NzForm::kPlain;
}

void Host::shift_a(Operation operation, CarryHome carry, Flags live) { shift(operation, kA, carry, live); }

void Host::modify_ram(unsigned offset, Operation operation, CarryHome carry, Flags live) {
  modify(kBoard, as_.layout.ram + static_cast<int>(offset), operation, carry, live);
}

void Host::modify_ram_at_offset(Operation operation, CarryHome carry, Flags live) {
  ram_at(kOffset);
  modify(kPlace, as_.layout.ram, operation, carry, live);
}

}  // namespace racebeam::translator

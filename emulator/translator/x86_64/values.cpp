// Registers, flags and the stack.
#include "emulator/translator/x86_64/operand.hpp"

namespace racebeam::translator {

void x86_64::Processor::into_al(const Value& value) {
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(as_.eax, value.number); break;
    case Value::Kind::kByte: break;
    default: as_.movzx(as_.eax, as_.byte[place_of(value)]); break;
  }
}

void Host::load(Reg to, const Value& value) {
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(reg_of(to), value.number); break;
    case Value::Kind::kByte: as_.mov(reg_of(to), as_.eax); break;
    default: as_.movzx(reg_of(to), as_.byte[place_of(value)]); break;
  }
  host_nz_ = false;
}

void Host::logic(Operation operation, const Value& value) {
  with_operand(value, [&](const auto& operand) {
    switch (operation) {
      case Operation::and_: as_.and_(as_.r12b, operand); break;
      case Operation::ora: as_.or_(as_.r12b, operand); break;
      default: as_.xor_(as_.r12b, operand); break;
    }
  });
  host_carry_ = HostCarry::kUnknown;
  host_nz_ = true;
}

// Moves the carry to the host's carry flag: unchanged for adc, inverted (a borrow) for sbb.
void x86_64::Processor::carry_to_host(CarryHome carry, bool inverted) {
  if (carry != CarryHome::kNumber) {
    if ((carry == CarryHome::kSet) != inverted)
      as_.stc();
    else
      as_.clc();
  } else if (inverted) {
    as_.cmp(as_.r9d, 1);
  } else {
    as_.bt(as_.r9d, 0);
  }
}

void x86_64::Processor::carry_from_host(bool inverted, Flags live) {
  if (live.c) {
    if (inverted)
      as_.setnc(as_.r9b);
    else
      as_.setc(as_.r9b);
  }
  host_carry_ = inverted ? HostCarry::kInverted : HostCarry::kSame;
}

void Host::add(bool subtracts, const Value& value, CarryHome carry, Flags live, Label& decimal) {
  as_.cmp(as_.byte_of(as_.layout.decimal), 0);
  as_.jne(decimal, kNear);
  carry_to_host(carry, subtracts);
  with_operand(value, [&](const auto& operand) {
    if (subtracts)
      as_.sbb(as_.r12b, operand);
    else
      as_.adc(as_.r12b, operand);
  });
  if (live.v) as_.seto(as_.byte_of(as_.layout.overflow));
  // Whether the carry is live does not matter: the out-of-line code for decimal mode makes it a number, too.
  carry_from_host(subtracts, Flags{});
  clobbered_flags();
}

void Host::compare(Reg reg, const Value& value, Flags live) {
  with_operand(value, [&](const auto& operand) {
    if (live.nz) {
      as_.movzx(as_.r8d, reg_of(reg).cvt8());
      as_.sub(as_.r8b, operand);
    } else {
      as_.cmp(reg_of(reg).cvt8(), operand);
    }
  });
  carry_from_host(true, live);
  host_nz_ = true;
}

// N and V are bits of the operand. Z is set if the operand and A have no set bit in common.
void Host::bit(const Value& value, Flags live) {
  into_al(value);
  if (live.v) {
    as_.test(as_.al, 0x40);
    as_.setnz(as_.byte_of(as_.layout.overflow));
  }
  if (live.nz) {
    as_.mov(as_.r8d, as_.eax);
    as_.and_(as_.r8d, 0x80);
    as_.shl(as_.r8d, 8);
    as_.xor_(as_.ecx, as_.ecx);
    as_.test(as_.r12b, as_.al);
    as_.setnz(as_.cl);
    as_.or_(as_.r8d, as_.ecx);
  }
  clobbered_flags();
}

void Host::transfer(Reg to, Reg from) {
  as_.mov(reg_of(to), reg_of(from));
  host_nz_ = false;
}

// INC and DEC preserve the host's carry.
void Host::step(Reg reg, int by) {
  if (by > 0)
    as_.inc(reg_of(reg).cvt8());
  else
    as_.dec(reg_of(reg).cvt8());
  host_nz_ = true;
}

void Host::carry_became_known() { host_carry_ = HostCarry::kUnknown; }
void Host::forget_nz() { host_nz_ = false; }
void Host::store(std::int32_t place, std::uint8_t byte) { as_.mov(as_.byte_of(place), byte); }

void Host::transfer_sp_to_x() {
  as_.movzx(as_.r13d, as_.byte_of(as_.layout.sp));
  host_nz_ = false;
}

void Host::transfer_x_to_sp() { as_.mov(as_.byte_of(as_.layout.sp), as_.r13b); }
void Host::load_sp() { as_.movzx(as_.eax, as_.byte_of(as_.layout.sp)); }

void Host::push(bool status, Label& device) {
  as_.test(as_.al, as_.al);
  as_.jns(device, kNear);
  as_.mov(as_.byte[as_.rbx + as_.rax + (as_.layout.ram - 0x80)], status ? as_.cl : as_.r12b);
  as_.dec(as_.byte_of(as_.layout.sp));
  clobbered_flags();
}

void Host::push_to_device(bool status) {
  as_.dec(as_.byte_of(as_.layout.sp));
  as_.or_(as_.eax, 0x100);
  if (!status) as_.mov(as_.ecx, as_.r12d);
}

// Reads the byte above the stack pointer.
void Host::pull(Label& outside) {
  load_sp();
  as_.lea(as_.ecx, as_.ptr[as_.rax - 0x80]);
  as_.cmp(as_.ecx, 0x7F);
  as_.jae(outside, kNear);
  as_.movzx(as_.r12d, as_.byte[as_.rbx + as_.rax + (as_.layout.ram - 0x7F)]);
  as_.inc(as_.al);
  as_.mov(as_.byte_of(as_.layout.sp), as_.al);
  clobbered_flags();
}

void x86_64::Processor::shift(Operation operation, Reg8 reg, CarryHome carry, Flags live) {
  const bool rotates = operation == Operation::rol || operation == Operation::ror;
  if (rotates) carry_to_host(carry, false);
  switch (operation) {
    case Operation::asl: as_.shl(reg, 1); break;
    case Operation::lsr: as_.shr(reg, 1); break;
    case Operation::rol: as_.rcl(reg, 1); break;
    default: as_.rcr(reg, 1); break;
  }
  carry_from_host(false, live);
  host_nz_ = !rotates;  // the host's rotations do not change ZF and SF
}

void x86_64::Processor::modify(const Xbyak::RegExp& place, Operation operation, CarryHome carry, Flags live) {
  const auto count = [&](const Xbyak::Operand& operand) {
    if (operation == Operation::inc)
      as_.inc(operand);
    else
      as_.dec(operand);
    host_nz_ = true;
  };
  const bool counts = operation == Operation::inc || operation == Operation::dec;
  if (counts && !live.nz) return count(as_.byte[place]);
  as_.movzx(as_.eax, as_.byte[place]);
  if (counts)
    count(as_.al);
  else
    shift(operation, as_.al, carry, live);
  as_.mov(as_.byte[place], as_.al);
  if (live.nz) as_.mov(as_.r8d, as_.eax);
}

void Host::shift_a(Operation operation, CarryHome carry, Flags live) {
  shift(operation, as_.r12b, carry, live);
}

void Host::modify_ram(unsigned offset, Operation operation, CarryHome carry, Flags live) {
  modify(ram(offset), operation, carry, live);
}

void Host::modify_ram_at_offset(Operation operation, CarryHome carry, Flags live) {
  modify(as_.rbx + as_.rcx + as_.layout.ram, operation, carry, live);
}

}  // namespace racebeam::translator

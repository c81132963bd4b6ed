// Jumps, branches, and the flags that they test.
#include "emulator/translator/host.hpp"

namespace racebeam::translator {

void Host::bind(Label& label) { as_.L(label); }
void Host::jump(Label& label) { as_.jmp(label, kNear); }
void Host::jump(const void* code) { as_.jmp(code, kNear); }

void Host::jump_through(const void* const* entry, Label& none) {
  as_.mov(as_.rsi, reinterpret_cast<std::uintptr_t>(entry));
  as_.mov(as_.rsi, as_.ptr[as_.rsi]);
  as_.test(as_.rsi, as_.rsi);
  as_.jz(none);
  as_.jmp(as_.rsi);
}

void Host::jump_at_limit(Label& reached, Distance distance) {
  as_.cmp(as_.ebp, as_.dword_of(as_.layout.limit));
  as_.jge(reached, distance == Distance::kNear ? kNear : Xbyak::CodeGenerator::T_AUTO);
}

void Host::leave(std::uint32_t exit) {
  as_.mov(as_.eax, exit);
  as_.jmp(as_.stubs.leave, kNear);
}

void Host::add_cycles(int cycles) { as_.add(as_.ebp, cycles); }

void Host::make_nz(NzHome home) {
  if (home != NzHome::kNumber) as_.mov(as_.r8d, reg_of(static_cast<Reg>(home)));
}

void Host::make_carry(bool set) { as_.mov(as_.r9d, set ? 1 : 0); }

// Sets the host's ZF to Z, or to the inverse of N where `sign`. Returns whether SF is N.
bool x86_64::Processor::test_nz(NzHome home, bool sign) {
  if (host_nz_) return true;
  if (home == NzHome::kNumber) {
    if (sign)
      as_.test(as_.r8d, 0x8080);
    else
      as_.test(as_.r8b, as_.r8b);
    clobbered_flags();
    return false;
  }
  const Reg8 reg = reg_of(static_cast<Reg>(home)).cvt8();
  as_.test(reg, reg);
  host_nz_ = true;
  host_carry_ = HostCarry::kUnknown;
  return true;
}

void x86_64::Processor::branch_on_carry(bool if_set, Label& taken) {
  bool on_host_carry = if_set;
  if (host_carry_ == HostCarry::kUnknown) {
    as_.test(as_.r9b, as_.r9b);
    clobbered_flags();
    if (if_set)
      as_.jnz(taken, kNear);
    else
      as_.jz(taken, kNear);
    return;
  }
  if (host_carry_ == HostCarry::kInverted) on_host_carry = !if_set;
  if (on_host_carry)
    as_.jc(taken, kNear);
  else
    as_.jnc(taken, kNear);
}

void Host::branch(Operation operation, NzHome nz, Label& taken) {
  switch (operation) {
    case Operation::bpl:
      if (test_nz(nz, true))
        as_.jns(taken, kNear);
      else
        as_.jz(taken, kNear);
      break;
    case Operation::bmi:
      if (test_nz(nz, true))
        as_.js(taken, kNear);
      else
        as_.jnz(taken, kNear);
      break;
    case Operation::bne:
      test_nz(nz, false);
      as_.jnz(taken, kNear);
      break;
    case Operation::beq:
      test_nz(nz, false);
      as_.jz(taken, kNear);
      break;
    case Operation::bvc:
    case Operation::bvs:
      as_.cmp(as_.byte_of(as_.layout.overflow), 0);
      clobbered_flags();
      if (operation == Operation::bvc)
        as_.je(taken, kNear);
      else
        as_.jne(taken, kNear);
      break;
    default: branch_on_carry(operation == Operation::bcs, taken); break;
  }
}

// The low byte is at the lower address, since the stack grows down.
void Host::push_return_address(std::uint16_t address, Label& outside) {
  as_.movzx(as_.eax, as_.byte_of(as_.layout.sp));
  as_.cmp(as_.al, 0x81);
  as_.jb(outside, kNear);
  as_.mov(as_.word[as_.rbx + as_.rax + (as_.layout.ram - 0x81)], address);
  as_.sub(as_.byte_of(as_.layout.sp), 2);
}

void Host::load_return_address(Label& interpret) {
  as_.movzx(as_.ecx, as_.byte_of(as_.layout.sp));
  as_.lea(as_.edx, as_.ptr[as_.rcx - 0x7F]);
  as_.cmp(as_.edx, 0x7E);
  as_.ja(interpret, kNear);
  as_.movzx(as_.eax, as_.word[as_.rbx + as_.rcx + (as_.layout.ram - 0x7F)]);
  as_.lea(as_.edx, as_.ptr[as_.rax + (1 - as_.window.code.first)]);
  as_.test(as_.edx, as_.edx);  // The CPU also reads the byte before the target.
  as_.jz(interpret, kNear);
}

void Host::drop_return_address() { as_.add(as_.byte_of(as_.layout.sp), 2); }

void Host::load_jump_address(unsigned pointer) {
  as_.movzx(as_.eax, as_.word[ram(pointer & 0x7F)]);
  as_.lea(as_.edx, as_.ptr[as_.rax - as_.window.code.first]);
}

// Expects the block's offset in edx.
void Host::find_block(Label& none) {
  as_.cmp(as_.edx, as_.window.code.span);
  as_.jae(none, kNear);
  as_.mov(as_.rsi, reinterpret_cast<std::uintptr_t>(as_.window.entries));
  as_.mov(as_.rsi, as_.ptr[as_.rsi + as_.rdx * 8]);
  as_.test(as_.rsi, as_.rsi);
  as_.jz(none, kNear);
  jump_at_limit(none, Distance::kNear);
}

void Host::jump_to_found_block(int cycles) {
  as_.add(as_.ebp, cycles);
  as_.jmp(as_.rsi);
}

void Host::leave_to_return_address(int cycles, Label& interpret) {
  as_.mov(as_.ecx, as_.eax);
  as_.shr(as_.ecx, 6);
  as_.movzx(as_.ecx, as_.cl);
  as_.cmp(as_.qword[as_.rbx + as_.rcx * 8 + as_.layout.pages], 0);
  as_.je(interpret, kNear);
  as_.lea(as_.edx, as_.ptr[as_.rax + 1]);
  as_.and_(as_.eax, as_.edx);
  as_.test(as_.ah, 0x10);
  as_.jz(interpret, kNear);
  drop_return_address();
  as_.add(as_.ebp, cycles);
  as_.movzx(as_.eax, as_.dx);
  as_.jmp(as_.stubs.leave, kNear);
}

}  // namespace racebeam::translator

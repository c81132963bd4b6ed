// Emits operations on registers, flags and the stack.
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/bus_calls.hpp"

namespace racebeam::translator {
namespace {

constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;

}  // namespace

void BlockEmitter::load(Reg32 to, const Value& value, NzHome home) {
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(to, value.constant); break;
    case Value::Kind::kMemory: as_.movzx(to, as_.byte[value.place]); break;
    case Value::Kind::kEax: as_.mov(to, as_.eax); break;
  }
  made_nz(home, false);
}

void BlockEmitter::logic(const Instruction& instruction, const Value& value) {
  const auto apply = [&](const auto& operand) {
    switch (instruction.operation) {
      case Operation::and_: as_.and_(as_.r12b, operand); break;
      case Operation::ora: as_.or_(as_.r12b, operand); break;
      default: as_.xor_(as_.r12b, operand); break;
    }
  };
  switch (value.kind) {
    case Value::Kind::kConstant: apply(static_cast<std::uint32_t>(value.constant)); break;
    case Value::Kind::kMemory: apply(as_.byte[value.place]); break;
    case Value::Kind::kEax: apply(as_.al); break;
  }
  host_carry_ = HostCarry::kUnknown;
  made_nz(NzHome::kA, true);
}

void BlockEmitter::into_al(const Value& value) {
  switch (value.kind) {
    case Value::Kind::kConstant: as_.mov(as_.eax, value.constant); break;
    case Value::Kind::kMemory: as_.movzx(as_.eax, as_.byte[value.place]); break;
    case Value::Kind::kEax: break;
  }
}

// Moves the carry to the host's: as it is for adc, inverted (a borrow) for sbb.
void BlockEmitter::carry_to_host(bool inverted) {
  if (carry_ != CarryHome::kNumber) {
    if ((carry_ == CarryHome::kSet) != inverted)
      as_.stc();
    else
      as_.clc();
  } else if (inverted) {
    as_.cmp(as_.r9d, 1);
  } else {
    as_.bt(as_.r9d, 0);
  }
}

void BlockEmitter::carry_from_host(bool inverted, Flags live) {
  if (live.c) {
    if (inverted)
      as_.setnc(as_.r9b);
    else
      as_.setc(as_.r9b);
  }
  carry_ = CarryHome::kNumber;
  host_carry_ = inverted ? HostCarry::kInverted : HostCarry::kSame;
}

void BlockEmitter::add(const Instruction& instruction, Value value, Flags live) {
  const bool subtracts = instruction.operation == Operation::sbc;
  Xbyak::Label decimal, done;
  as_.cmp(as_.byte_of(as_.layout.decimal), 0);
  as_.jne(decimal, kNear);
  carry_to_host(subtracts);
  const auto apply = [&](const auto& operand) {
    if (subtracts)
      as_.sbb(as_.r12b, operand);
    else
      as_.adc(as_.r12b, operand);
  };
  switch (value.kind) {
    case Value::Kind::kConstant: apply(static_cast<std::uint32_t>(value.constant)); break;
    case Value::Kind::kMemory: apply(as_.byte[value.place]); break;
    case Value::Kind::kEax: apply(as_.al); break;
  }
  if (live.v) as_.seto(as_.byte_of(as_.layout.overflow));
  const ExitState before = exit_state();
  // All flags, live or not: the out-of-line code for decimal mode returns here with them.
  carry_from_host(subtracts, Flags{});
  as_.L(done);
  clobbered_flags();
  made_nz(NzHome::kA, false);
  cold([this, value, before, subtracts, decimal, done]() mutable {
    as_.L(decimal);
    into_al(value);
    if (before.carry != CarryHome::kNumber) as_.mov(as_.r9d, before.carry == CarryHome::kSet ? 1 : 0);
    call_decimal(as_, subtracts);
    if (before.rom_loaded) load_rom_again();
    as_.jmp(done, kNear);
  });
}

void BlockEmitter::compare(Reg8 reg, const Value& value, Flags live) {
  const auto apply = [&](const auto& operand) {
    if (live.nz) {
      as_.movzx(as_.r8d, reg);
      as_.sub(as_.r8b, operand);
    } else {
      as_.cmp(reg, operand);
    }
  };
  switch (value.kind) {
    case Value::Kind::kConstant: apply(static_cast<std::uint32_t>(value.constant)); break;
    case Value::Kind::kMemory: apply(as_.byte[value.place]); break;
    case Value::Kind::kEax: apply(as_.al); break;
  }
  carry_from_host(true, live);
  made_nz(NzHome::kNumber, true);
}

// N and V are bits of the operand. Z tells whether it has no bit in common with A.
void BlockEmitter::bit(const Value& value, Flags live) {
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
  made_nz(NzHome::kNumber, false);
}

void BlockEmitter::implied(const Instruction& instruction, Flags) {
  const auto transfer = [this](Reg32 to, Reg32 from, NzHome home) {
    as_.mov(to, from);
    made_nz(home, false);
  };
  const auto step = [this](Reg8 reg, bool up, NzHome home) {
    if (up)
      as_.inc(reg);
    else
      as_.dec(reg);
    made_nz(home, true);  // INC and DEC preserve the host's carry
  };
  // clang-format off
  switch (instruction.operation) {
    case Operation::clc: carry_ = CarryHome::kClear; host_carry_ = HostCarry::kUnknown; break;
    case Operation::sec: carry_ = CarryHome::kSet; host_carry_ = HostCarry::kUnknown; break;
    case Operation::cld: as_.mov(as_.byte_of(as_.layout.decimal), 0); break;
    case Operation::sed: as_.mov(as_.byte_of(as_.layout.decimal), 1); break;
    case Operation::cli: as_.mov(as_.byte_of(as_.layout.interrupt), 0); break;
    case Operation::sei: as_.mov(as_.byte_of(as_.layout.interrupt), 1); break;
    case Operation::clv: as_.mov(as_.byte_of(as_.layout.overflow), 0); break;
    case Operation::tax: transfer(as_.r13d, as_.r12d, NzHome::kX); break;
    case Operation::tay: transfer(as_.r14d, as_.r12d, NzHome::kY); break;
    case Operation::txa: transfer(as_.r12d, as_.r13d, NzHome::kA); break;
    case Operation::tya: transfer(as_.r12d, as_.r14d, NzHome::kA); break;
    case Operation::tsx:
      as_.movzx(as_.r13d, as_.byte_of(as_.layout.sp));
      made_nz(NzHome::kX, false);
      break;
    case Operation::txs: as_.mov(as_.byte_of(as_.layout.sp), as_.r13b); break;
    case Operation::inx: step(as_.r13b, true, NzHome::kX); break;
    case Operation::dex: step(as_.r13b, false, NzHome::kX); break;
    case Operation::iny: step(as_.r14b, true, NzHome::kY); break;
    case Operation::dey: step(as_.r14b, false, NzHome::kY); break;
    case Operation::pha: case Operation::php: push(instruction); break;
    case Operation::pla: pull(instruction); break;
    default: break;  // nop
  }
  // clang-format on
}

// Where the stack pointer is in the TIA, games write registers with PHP and PHA.
void BlockEmitter::push(const Instruction& instruction) {
  Xbyak::Label device, done;
  const bool pushes_status = instruction.operation == Operation::php;
  const ExitState before = exit_state();
  as_.movzx(as_.eax, as_.byte_of(as_.layout.sp));
  if (pushes_status) {
    ExitState now = before;
    now.elapsed = 0;
    settle(now);
    nz_ = NzHome::kNumber;
    carry_ = CarryHome::kNumber;
    status_into_ecx(as_);
  }
  clobbered_flags();
  const ExitState exit = exit_state();
  as_.test(as_.al, as_.al);
  as_.jns(device, kNear);
  as_.mov(as_.byte[as_.rbx + as_.rax + (as_.layout.ram - 0x80)], pushes_status ? as_.cl : as_.r12b);
  as_.dec(as_.byte_of(as_.layout.sp));
  as_.L(done);
  cold([this, instruction, exit, pushes_status, device, done]() mutable {
    as_.L(device);
    as_.dec(as_.byte_of(as_.layout.sp));
    as_.or_(as_.eax, 0x100);
    if (!pushes_status) as_.mov(as_.ecx, as_.r12d);
    call_write(instruction, as_.ecx, exit);
    as_.jmp(done, kNear);
  });
}

// Reads above the stack pointer. Outside RAM, that read may have an effect.
void BlockEmitter::pull(const Instruction& instruction) {
  Xbyak::Label outside, done;
  as_.movzx(as_.eax, as_.byte_of(as_.layout.sp));
  as_.lea(as_.ecx, as_.ptr[as_.rax - 0x80]);
  as_.cmp(as_.ecx, 0x7F);
  as_.jae(outside, kNear);
  as_.movzx(as_.r12d, as_.byte[as_.rbx + as_.rax + (as_.layout.ram - 0x7F)]);
  as_.inc(as_.al);
  as_.mov(as_.byte_of(as_.layout.sp), as_.al);
  as_.L(done);
  clobbered_flags();
  made_nz(NzHome::kA, false);
  cold([this, instruction, exit = exit_state(), outside, done]() mutable {
    as_.L(outside);
    as_.lea(as_.edx, as_.ptr[as_.rbp + (exit.elapsed + instruction.cycles)]);
    call_pull(as_);
    as_.mov(as_.r12d, as_.eax);
    if (exit.rom_loaded) load_rom_again();
    as_.jmp(done, kNear);
  });
}

void BlockEmitter::modify(const Instruction& instruction, Flags live) {
  if (instruction.access == Access::Accumulator) {
    shift(instruction.operation, as_.r12b, live);
    // The host's rotations do not change ZF and SF.
    const bool rotates = instruction.operation == Operation::rol || instruction.operation == Operation::ror;
    made_nz(NzHome::kA, !rotates);
    return;
  }
  Xbyak::Label outside;
  const ExitState before = exit_state();
  Xbyak::RegExp place;
  const bool fixed = instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute;
  if (fixed) {
    if (!is_ram(instruction.operand)) {
      settle(before);
      exit_before(instruction);
      made_nz(NzHome::kNumber, false);
      return;
    }
    place = as_.rbx + (as_.layout.ram + (instruction.operand & 0x7F));
  } else {
    if (instruction.mode == Mode::zero_page_x) {
      as_.lea(as_.ecx, as_.ptr[as_.r13 + (instruction.operand - 0x80)]);
      as_.movzx(as_.ecx, as_.cl);
      as_.test(as_.cl, as_.cl);
      as_.js(outside, kNear);
    } else {
      as_.lea(as_.ecx, as_.ptr[as_.r13 + instruction.operand]);
      as_.mov(as_.eax, as_.ecx);
      as_.and_(as_.eax, 0x1280);
      as_.cmp(as_.eax, 0x80);
      as_.jne(outside, kNear);
      as_.and_(as_.ecx, 0x7F);
    }
    place = as_.rbx + as_.rcx + as_.layout.ram;
    clobbered_flags();
    exit_out_of_line(outside, instruction, before);
  }
  const bool counts = instruction.operation == Operation::inc || instruction.operation == Operation::dec;
  if (counts && !live.nz) {
    if (instruction.operation == Operation::inc)
      as_.inc(as_.byte[place]);
    else
      as_.dec(as_.byte[place]);
    made_nz(NzHome::kNumber, true);
    return;
  }
  as_.movzx(as_.eax, as_.byte[place]);
  if (instruction.operation == Operation::inc)
    as_.inc(as_.al);
  else if (instruction.operation == Operation::dec)
    as_.dec(as_.al);
  else
    shift(instruction.operation, as_.al, live);
  as_.mov(as_.byte[place], as_.al);
  if (live.nz) as_.mov(as_.r8d, as_.eax);
  const bool rotates = instruction.operation == Operation::rol || instruction.operation == Operation::ror;
  made_nz(NzHome::kNumber, !rotates);
}

void BlockEmitter::shift(Operation operation, const Xbyak::Operand& operand, Flags live) {
  const Xbyak::Reg8 reg(operand.getIdx());
  switch (operation) {
    case Operation::asl: as_.shl(reg, 1); break;
    case Operation::lsr: as_.shr(reg, 1); break;
    case Operation::rol:
      carry_to_host(false);
      as_.rcl(reg, 1);
      break;
    default:
      carry_to_host(false);
      as_.rcr(reg, 1);
      break;
  }
  carry_from_host(false, live);
}

}  // namespace racebeam::translator

#include "emulator/translator/block_emitter.hpp"

#include "emulator/cpu/timer_loop.hpp"
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/bus_calls.hpp"

namespace racebeam::translator {

BlockEmitter::BlockEmitter(Assembler& assembler, const Block& block) : as_(assembler), block_(block) {}

void BlockEmitter::emit() {
  as_.L(as_.blocks[block_.pc]);
  if (block_.instructions.empty()) {
    as_.mov(as_.eax, block_.pc | kInterpretNext);
    as_.jmp(as_.exit_stub, Xbyak::CodeGenerator::T_NEAR);
    return;
  }
  check_limit();
  const std::vector<Flags> live = live_flags(block_, as_.window);
  for (std::size_t i = 0; i < block_.instructions.size(); ++i) emit(block_.instructions[i], live[i]);
  if (block_.instructions.back().access != Access::Jump) {
    settle(exit_state());
    jump_to(block_.next);
  }
  for (std::size_t i = 0; i < cold_.size(); ++i) cold_[i]();
}

// Checks the line limit in loops, and before writes to the TIA, because such a write closes the frame past
// the limit.
void BlockEmitter::check_limit() {
  bool matters = block_.is_loop_head;
  for (const Instruction& instruction : block_.instructions)
    matters = matters || may_write_device(instruction);
  if (!matters) return;
  Xbyak::Label reached;
  as_.cmp(as_.ebp, as_.dword_of(as_.layout.limit));
  as_.jge(reached, Xbyak::CodeGenerator::T_NEAR);
  cold([this, reached]() mutable {
    as_.L(reached);
    as_.mov(as_.eax, block_.pc);
    as_.jmp(as_.exit_stub, Xbyak::CodeGenerator::T_NEAR);
  });
}

void BlockEmitter::emit(const Instruction& instruction, Flags live) {
  // clang-format off
  switch (instruction.access) {
    case Access::Read: case Access::Immediate: emit_read(instruction, live); break;
    case Access::Write: write(instruction); break;
    case Access::Modify: case Access::Accumulator: modify(instruction, live); break;
    case Access::Implied: implied(instruction, live); break;
    case Access::Branch: emit_branch(instruction); return;
    case Access::Jump: emit_jump(instruction); return;
  }
  // clang-format on
  elapsed_ += instruction.cycles;
}

void BlockEmitter::emit_read(const Instruction& instruction, Flags live) {
  const Value value = read(instruction);
  // clang-format off
  switch (instruction.operation) {
    case Operation::lda: return load(as_.r12d, value, NzHome::kA);
    case Operation::ldx: return load(as_.r13d, value, NzHome::kX);
    case Operation::ldy: return load(as_.r14d, value, NzHome::kY);
    case Operation::and_: case Operation::ora: case Operation::eor: return logic(instruction, value);
    case Operation::adc: case Operation::sbc: return add(instruction, value, live);
    case Operation::cmp: return compare(as_.r12b, value, live);
    case Operation::cpx: return compare(as_.r13b, value, live);
    case Operation::cpy: return compare(as_.r14b, value, live);
    default: return bit(value, live);
  }
  // clang-format on
}

void BlockEmitter::settle(const ExitState& exit) {
  if (exit.elapsed != 0) as_.add(as_.ebp, exit.elapsed);
  switch (exit.nz) {
    case NzHome::kNumber: break;
    case NzHome::kA: as_.mov(as_.r8d, as_.r12d); break;
    case NzHome::kX: as_.mov(as_.r8d, as_.r13d); break;
    case NzHome::kY: as_.mov(as_.r8d, as_.r14d); break;
  }
  if (exit.carry != CarryHome::kNumber) as_.mov(as_.r9d, exit.carry == CarryHome::kSet ? 1 : 0);
}

void BlockEmitter::exit_before(const Instruction& instruction) {
  as_.mov(as_.eax, instruction.pc | kInterpretNext);
  as_.jmp(as_.exit_stub, Xbyak::CodeGenerator::T_NEAR);
}

// Emits code at `label`, out of line: the interpreter executes the instruction. exit: what is known at the
// jump to `label`.
void BlockEmitter::exit_out_of_line(Xbyak::Label label, const Instruction& instruction,
                                    const ExitState& exit) {
  cold([this, instruction, exit, label]() mutable {
    as_.L(label);
    settle(exit);
    exit_before(instruction);
  });
}

// Requires that the flags and the cycle are settled.
void BlockEmitter::jump_to(std::uint16_t target) {
  const auto found = as_.blocks.find(target);
  if (found != as_.blocks.end()) {
    as_.jmp(found->second, Xbyak::CodeGenerator::T_NEAR);
    return;
  }
  if (contains(as_.window.code, target)) jump_to_other_batch(target);
  as_.mov(as_.eax, target);
  as_.jmp(as_.exit_stub, Xbyak::CodeGenerator::T_NEAR);
}

// Jumps if the block at `target` exists and the limit is not reached; else continues after it. The limit is
// checked here because the jump may close a loop across two batches, in which no other block checks it.
void BlockEmitter::jump_to_other_batch(std::uint16_t target) {
  Xbyak::Label stays;
  as_.cmp(as_.ebp, as_.dword_of(as_.layout.limit));
  as_.jge(stays);
  const void* const* const entry = &as_.window.entries[as_.offset_of(target)];
  if (*entry != nullptr) {
    as_.jmp(*entry, Xbyak::CodeGenerator::T_NEAR);
  } else {
    as_.mov(as_.rsi, reinterpret_cast<std::uintptr_t>(entry));
    as_.mov(as_.rsi, as_.ptr[as_.rsi]);
    as_.test(as_.rsi, as_.rsi);
    as_.jz(stays);
    as_.jmp(as_.rsi);
  }
  as_.L(stays);
}

void BlockEmitter::emit_branch(const Instruction& instruction) {
  elapsed_ += instruction.cycles;
  Xbyak::Label taken;
  constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;
  const auto test_nz = [this](bool only_zero) {
    if (host_nz_) return;
    switch (nz_) {
      case NzHome::kA: as_.test(as_.r12b, as_.r12b); break;
      case NzHome::kX: as_.test(as_.r13b, as_.r13b); break;
      case NzHome::kY: as_.test(as_.r14b, as_.r14b); break;
      case NzHome::kNumber:
        if (only_zero)
          as_.test(as_.r8b, as_.r8b);
        else
          as_.test(as_.r8d, 0x8080);
        return;
    }
    host_nz_ = true;
    host_carry_ = HostCarry::kUnknown;
  };
  const bool number = nz_ == NzHome::kNumber && !host_nz_;
  const auto test_byte = [this](std::int32_t place) { as_.cmp(as_.byte_of(place), 0); };
  const auto clobber = [this] { clobbered_flags(); };
  switch (instruction.operation) {
    case Operation::bpl:
      test_nz(false);
      if (number)
        as_.jz(taken, kNear), clobber();
      else
        as_.jns(taken, kNear);
      break;
    case Operation::bmi:
      test_nz(false);
      if (number)
        as_.jnz(taken, kNear), clobber();
      else
        as_.js(taken, kNear);
      break;
    case Operation::bne:
      test_nz(true);
      as_.jnz(taken, kNear);
      if (number) clobber();
      break;
    case Operation::beq:
      test_nz(true);
      as_.jz(taken, kNear);
      if (number) clobber();
      break;
    case Operation::bvc:
      test_byte(as_.layout.overflow);
      as_.je(taken, kNear);
      clobber();
      break;
    case Operation::bvs:
      test_byte(as_.layout.overflow);
      as_.jne(taken, kNear);
      clobber();
      break;
    default: {
      const bool if_set = instruction.operation == Operation::bcs;
      if (carry_ != CarryHome::kNumber) {
        if ((carry_ == CarryHome::kSet) != if_set) return;  // never taken
        as_.jmp(taken, kNear);
      } else if (host_carry_ != HostCarry::kUnknown) {
        if ((host_carry_ == HostCarry::kSame) == if_set)
          as_.jc(taken, kNear);
        else
          as_.jnc(taken, kNear);
      } else {
        as_.test(as_.r9b, as_.r9b);
        clobber();
        if (if_set)
          as_.jnz(taken, kNear);
        else
          as_.jz(taken, kNear);
      }
      break;
    }
  }
  ExitState exit = exit_state();
  const int penalty = (instruction.next() ^ instruction.target()) & 0xFF00 ? 2 : 1;
  exit.elapsed += penalty;
  cold([this, instruction, exit, penalty, taken]() mutable {
    as_.L(taken);
    settle(exit);
    const std::uint16_t read = instruction.target();
    if (static_cast<std::int8_t>(instruction.operand) == kTimerLoopOffset && as_.covers(read) &&
        is_timer_loop(as_.window.code.memory + as_.offset_of(instruction.pc))) {
      constexpr int kLoadCycles = 4, kBranchCycles = 2;
      call_skip_timer_loop(as_, as_.window.code.memory + as_.offset_of(instruction.pc),
                           kLoadCycles + kBranchCycles + penalty);
    }
    jump_to(instruction.target());
  });
}

void BlockEmitter::emit_jump(const Instruction& instruction) {
  if (instruction.operation == Operation::jsr) return jsr(instruction);
  if (instruction.operation == Operation::rts) return rts(instruction);
  if (instruction.mode == Mode::indirect) return jmp_indirect(instruction);
  const bool is_known = can_jump_to(instruction.target());
  if (is_known) elapsed_ += instruction.cycles;
  settle(exit_state());
  if (is_known)
    jump_to(instruction.target());
  else
    exit_before(instruction);
}

// Whether execution may continue at `target` without the interpreter. Code on the cartridge does not depend
// on the data bus.
bool BlockEmitter::can_jump_to(std::uint16_t target) const {
  return contains(as_.window.code, target) || is_cartridge(target);
}

// Both bytes of the pointer must be in RAM.
void BlockEmitter::jmp_indirect(const Instruction& instruction) {
  settle(exit_state());
  if (!is_ram(instruction.operand) || (instruction.operand & 0x7F) == 0x7F) return exit_before(instruction);
  Xbyak::Label outside;
  as_.movzx(as_.eax, as_.word[as_.rbx + (as_.layout.ram + (instruction.operand & 0x7F))]);
  as_.lea(as_.edx, as_.ptr[as_.rax - as_.window.code.first]);
  find_block(outside);
  jump_to_block(instruction);
  exit_out_of_line(outside, instruction, {0, NzHome::kNumber, CarryHome::kNumber, false});
}

// Loads the code of the block at the offset in edx into rsi. Jumps to `none` if it does not exist, or the
// limit is reached.
void BlockEmitter::find_block(Xbyak::Label& none) {
  constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;
  as_.cmp(as_.edx, as_.window.code.span);
  as_.jae(none, kNear);
  as_.mov(as_.rsi, reinterpret_cast<std::uintptr_t>(as_.window.entries));
  as_.mov(as_.rsi, as_.ptr[as_.rsi + as_.rdx * 8]);
  as_.test(as_.rsi, as_.rsi);
  as_.jz(none, kNear);
  as_.cmp(as_.ebp, as_.dword_of(as_.layout.limit));
  as_.jge(none, kNear);
}

void BlockEmitter::jump_to_block(const Instruction& instruction) {
  as_.add(as_.ebp, instruction.cycles);
  as_.jmp(as_.rsi);
}

// Both bytes of the return address must be written to RAM.
void BlockEmitter::jsr(const Instruction& instruction) {
  Xbyak::Label outside;
  const ExitState before = exit_state();
  if (!can_jump_to(instruction.target()) || !as_.covers(instruction.pc, 3)) {
    settle(before);
    exit_before(instruction);
    return;
  }
  as_.movzx(as_.eax, as_.byte_of(as_.layout.sp));
  as_.cmp(as_.al, 0x81);
  as_.jb(outside, Xbyak::CodeGenerator::T_NEAR);
  const unsigned pushed = static_cast<std::uint16_t>(instruction.pc + 2);
  // The low byte is below the high one, as the stack grows down.
  as_.mov(as_.word[as_.rbx + as_.rax + (as_.layout.ram - 0x81)], pushed);
  as_.sub(as_.byte_of(as_.layout.sp), 2);
  elapsed_ += instruction.cycles;
  settle(exit_state());
  jump_to(instruction.target());
  exit_out_of_line(outside, instruction, before);
}

// The return address must be in RAM, and lead into the window or elsewhere in the cartridge.
void BlockEmitter::rts(const Instruction& instruction) {
  constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;
  Xbyak::Label outside, interpret;
  settle(exit_state());
  as_.movzx(as_.ecx, as_.byte_of(as_.layout.sp));
  as_.lea(as_.edx, as_.ptr[as_.rcx - 0x7F]);
  as_.cmp(as_.edx, 0x7E);
  as_.ja(interpret, kNear);
  as_.movzx(as_.eax, as_.word[as_.rbx + as_.rcx + (as_.layout.ram - 0x7F)]);
  as_.lea(as_.edx, as_.ptr[as_.rax + (1 - as_.window.code.first)]);
  as_.test(as_.edx, as_.edx);  // The CPU also reads the byte before the target.
  as_.jz(interpret, kNear);
  find_block(outside);
  as_.add(as_.byte_of(as_.layout.sp), 2);
  jump_to_block(instruction);
  cold([this, instruction, outside, interpret]() mutable {
    as_.L(outside);
    return_to_cartridge(instruction, interpret);
  });
  exit_out_of_line(interpret, instruction, {0, NzHome::kNumber, CarryHome::kNumber, false});
}

// Returns to the address after the one in eax. Both must be on the cartridge, and reading the first must have
// no effect.
void BlockEmitter::return_to_cartridge(const Instruction& instruction, Xbyak::Label& interpret) {
  constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;
  as_.mov(as_.ecx, as_.eax);
  as_.shr(as_.ecx, 6);
  as_.movzx(as_.ecx, as_.cl);
  as_.cmp(as_.qword[as_.rbx + as_.rcx * 8 + as_.layout.pages], 0);
  as_.je(interpret, kNear);
  as_.lea(as_.edx, as_.ptr[as_.rax + 1]);
  as_.and_(as_.eax, as_.edx);
  as_.test(as_.ah, 0x10);
  as_.jz(interpret, kNear);
  as_.add(as_.byte_of(as_.layout.sp), 2);
  as_.add(as_.ebp, instruction.cycles);
  as_.movzx(as_.eax, as_.dx);
  as_.jmp(as_.exit_stub, kNear);
}

}  // namespace racebeam::translator

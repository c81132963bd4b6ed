#include "emulator/translator/block_emitter.hpp"

#include "emulator/cpu/timer_loop.hpp"
#include "emulator/translator/addresses.hpp"

namespace racebeam::translator {

BlockEmitter::BlockEmitter(Assembler& assembler, const Block& block)
    : as_(assembler), host_(assembler), block_(block) {}

void BlockEmitter::emit() {
  host_.bind(as_.blocks[block_.pc]);
  if (block_.instructions.empty()) return host_.leave(block_.pc | kInterpretNext);
  check_limit();
  const std::vector<Flags> live = live_flags(block_, as_.window);
  for (std::size_t i = 0; i < block_.instructions.size(); ++i) emit(block_.instructions[i], live[i]);
  if (block_.instructions.back().access != Access::Jump) {
    settle(exit_state());
    jump_to(block_.next);
  }
  for (std::size_t i = 0; i < cold_.size(); ++i) cold_[i]();
}

// Checks the line limit in loops and before writes to the TIA. Past the limit, such a write closes the frame.
void BlockEmitter::check_limit() {
  bool matters = block_.is_loop_head;
  for (const Instruction& instruction : block_.instructions)
    matters = matters || may_write_device(instruction);
  if (!matters) return;
  Label reached;
  host_.jump_at_limit(reached, Host::Distance::kNear);
  cold([this, reached]() mutable {
    host_.bind(reached);
    host_.leave(block_.pc);
  });
}

void BlockEmitter::emit(const Instruction& instruction, Flags live) {
  // clang-format off
  switch (instruction.access) {
    case Access::Read: case Access::Immediate: emit_read(instruction, live); break;
    case Access::Write: write(instruction); break;
    case Access::Modify: case Access::Accumulator: modify(instruction, live); break;
    case Access::Implied: implied(instruction); break;
    case Access::Branch: emit_branch(instruction); return;
    case Access::Jump: emit_jump(instruction); return;
  }
  // clang-format on
  elapsed_ += instruction.cycles;
}

void BlockEmitter::emit_read(const Instruction& instruction, Flags live) {
  const Value value = read(instruction);
  const auto load = [&](Reg to, NzHome home) {
    host_.load(to, value);
    nz_ = home;
  };
  const auto compare = [&](Reg reg) {
    host_.compare(reg, value, live);
    nz_ = NzHome::kNumber;
    carry_ = CarryHome::kNumber;
  };
  switch (instruction.operation) {
    case Operation::lda: load(Reg::kA, NzHome::kA); break;
    case Operation::ldx: load(Reg::kX, NzHome::kX); break;
    case Operation::ldy: load(Reg::kY, NzHome::kY); break;
    case Operation::and_:
    case Operation::ora:
    case Operation::eor:
      host_.logic(instruction.operation, value);
      nz_ = NzHome::kA;
      break;
    case Operation::adc:
    case Operation::sbc: add(instruction, value, live); break;
    case Operation::cmp: compare(Reg::kA); break;
    case Operation::cpx: compare(Reg::kX); break;
    case Operation::cpy: compare(Reg::kY); break;
    default:
      host_.bit(value, live);
      nz_ = NzHome::kNumber;
      break;
  }
}

void BlockEmitter::settle(const ExitState& exit) {
  if (exit.elapsed != 0) host_.add_cycles(exit.elapsed);
  host_.make_nz(exit.nz);
  if (exit.carry != CarryHome::kNumber) host_.make_carry(exit.carry == CarryHome::kSet);
}

void BlockEmitter::exit_before(const Instruction& instruction) {
  host_.leave(instruction.pc | kInterpretNext);
}

// Emits code at `label`, out of line, which lets the interpreter execute the instruction. exit: what is known
// at the jump to `label`.
void BlockEmitter::exit_out_of_line(Label label, const Instruction& instruction, const ExitState& exit) {
  cold([this, instruction, exit, label]() mutable {
    host_.bind(label);
    settle(exit);
    exit_before(instruction);
  });
}

// Requires that the flags and the cycle are settled.
void BlockEmitter::jump_to(std::uint16_t target) {
  const auto found = as_.blocks.find(target);
  if (found != as_.blocks.end()) return host_.jump(found->second);
  if (contains(as_.window.code, target)) jump_to_other_batch(target);
  host_.leave(target);
}

// Emits a jump to the block at `target`, taken if that block exists and the limit is not reached. The jump
// checks the limit because it may close a loop across two batches, in which no other block does so.
void BlockEmitter::jump_to_other_batch(std::uint16_t target) {
  Label stays;
  host_.jump_at_limit(stays, Host::Distance::kShort);
  const void* const* const entry = &as_.window.entries[as_.window.offset_of(target)];
  if (*entry != nullptr)
    host_.jump(*entry);
  else
    host_.jump_through(entry, stays);
  host_.bind(stays);
}

void BlockEmitter::emit_branch(const Instruction& instruction) {
  elapsed_ += instruction.cycles;
  const bool if_set = instruction.operation == Operation::bcs;
  const bool knows = (if_set || instruction.operation == Operation::bcc) && carry_ != CarryHome::kNumber;
  if (knows && (carry_ == CarryHome::kSet) != if_set) return;  // never taken
  Label taken;
  if (knows)
    host_.jump(taken);
  else
    host_.branch(instruction.operation, nz_, taken);
  ExitState exit = exit_state();
  const int penalty = (instruction.next() ^ instruction.target()) & 0xFF00 ? 2 : 1;
  exit.elapsed += penalty;
  cold([this, instruction, exit, penalty, taken]() mutable {
    host_.bind(taken);
    settle(exit);
    skip_timer_loop(instruction, penalty);
    jump_to(instruction.target());
  });
}

// Emits the call only if the branch closes a timer loop.
void BlockEmitter::skip_timer_loop(const Instruction& instruction, int penalty) {
  constexpr int kLoadCycles = 4, kBranchCycles = 2;
  if (static_cast<std::int8_t>(instruction.operand) != kTimerLoopOffset) return;
  if (!as_.window.covers(instruction.target())) return;
  const std::uint8_t* branch = as_.window.code.memory + as_.window.offset_of(instruction.pc);
  if (is_timer_loop(branch)) host_.skip_timer_loop(branch, kLoadCycles + kBranchCycles + penalty);
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

// Both bytes of the pointer must be in RAM; otherwise the interpreter executes the jump.
void BlockEmitter::jmp_indirect(const Instruction& instruction) {
  settle(exit_state());
  if (!is_ram(instruction.operand) || (instruction.operand & 0x7F) == 0x7F) return exit_before(instruction);
  Label outside;
  host_.load_jump_address(instruction.operand);
  host_.find_block(outside);
  host_.jump_to_found_block(instruction.cycles);
  exit_out_of_line(outside, instruction, kSettled);
}

// Both bytes of the return address must go to RAM; otherwise the interpreter executes the call.
void BlockEmitter::jsr(const Instruction& instruction) {
  Label outside;
  const ExitState before = exit_state();
  if (!can_jump_to(instruction.target()) || !as_.window.covers(instruction.pc, 3)) {
    settle(before);
    return exit_before(instruction);
  }
  host_.push_return_address(static_cast<std::uint16_t>(instruction.pc + 2), outside);
  elapsed_ += instruction.cycles;
  settle(exit_state());
  jump_to(instruction.target());
  exit_out_of_line(outside, instruction, before);
}

// The return address must be in RAM, and point into the window or elsewhere into the cartridge. The read of
// the byte before the target must not have an effect. Otherwise the interpreter executes the return.
void BlockEmitter::rts(const Instruction& instruction) {
  Label outside, interpret;
  settle(exit_state());
  host_.load_return_address(interpret);
  host_.find_block(outside);
  host_.drop_return_address();
  host_.jump_to_found_block(instruction.cycles);
  cold([this, instruction, outside, interpret]() mutable {
    host_.bind(outside);
    host_.leave_to_return_address(instruction.cycles, interpret);
  });
  exit_out_of_line(interpret, instruction, kSettled);
}

}  // namespace racebeam::translator

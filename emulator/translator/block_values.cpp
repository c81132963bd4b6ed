// Plans operations on registers, flags and the stack.
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"

namespace racebeam::translator {

void BlockEmitter::add(const Instruction& instruction, const Value& value, Flags live) {
  const bool subtracts = instruction.operation == Operation::sbc;
  Label decimal, done;
  const ExitState before = exit_state();
  host_.add(subtracts, value, before.carry, live, decimal);
  host_.bind(done);
  nz_ = NzHome::kA;
  carry_ = CarryHome::kNumber;
  cold([this, value, before, subtracts, decimal, done]() mutable {
    host_.bind(decimal);
    host_.add_decimal(subtracts, value, before.carry);
    load_rom_again(before);
    host_.jump(done);
  });
}

void BlockEmitter::implied(const Instruction& instruction) {
  const auto transfer = [this](Reg to, Reg from) {
    host_.transfer(to, from);
    nz_ = static_cast<NzHome>(to);
  };
  const auto step = [this](Reg reg, int by) {
    host_.step(reg, by);
    nz_ = static_cast<NzHome>(reg);
  };
  const auto know_carry = [this](CarryHome carry) {
    host_.carry_became_known();
    carry_ = carry;
  };
  const Layout& places = as_.layout;
  // clang-format off
  switch (instruction.operation) {
    case Operation::clc: know_carry(CarryHome::kClear); break;
    case Operation::sec: know_carry(CarryHome::kSet); break;
    case Operation::cld: host_.store(places.decimal, 0); break;
    case Operation::sed: host_.store(places.decimal, 1); break;
    case Operation::cli: host_.store(places.interrupt, 0); break;
    case Operation::sei: host_.store(places.interrupt, 1); break;
    case Operation::clv: host_.store(places.overflow, 0); break;
    case Operation::tax: transfer(Reg::kX, Reg::kA); break;
    case Operation::tay: transfer(Reg::kY, Reg::kA); break;
    case Operation::txa: transfer(Reg::kA, Reg::kX); break;
    case Operation::tya: transfer(Reg::kA, Reg::kY); break;
    case Operation::tsx: host_.transfer_sp_to_x(); nz_ = NzHome::kX; break;
    case Operation::txs: host_.transfer_x_to_sp(); break;
    case Operation::inx: step(Reg::kX, 1); break;
    case Operation::dex: step(Reg::kX, -1); break;
    case Operation::iny: step(Reg::kY, 1); break;
    case Operation::dey: step(Reg::kY, -1); break;
    case Operation::pha: case Operation::php: push(instruction); break;
    case Operation::pla: pull(instruction); break;
    default: break;  // nop
  }
  // clang-format on
}

// Some games set the stack pointer to the TIA, and write its registers with PHP and PHA.
void BlockEmitter::push(const Instruction& instruction) {
  Label device, done;
  const bool pushes_status = instruction.operation == Operation::php;
  host_.load_sp();
  if (pushes_status) {
    settle({0, nz_, carry_, rom_loaded_});
    nz_ = NzHome::kNumber;
    carry_ = CarryHome::kNumber;
    host_.load_status();
  }
  host_.push(pushes_status, device);
  host_.bind(done);
  cold([this, instruction, exit = exit_state(), pushes_status, device, done]() mutable {
    host_.bind(device);
    host_.push_to_device(pushes_status);
    call_write(instruction, exit);
    host_.jump(done);
  });
}

// A read outside RAM may have an effect.
void BlockEmitter::pull(const Instruction& instruction) {
  Label outside, done;
  host_.pull(outside);
  host_.bind(done);
  nz_ = NzHome::kA;
  cold([this, instruction, exit = exit_state(), outside, done]() mutable {
    host_.bind(outside);
    host_.pull_over_bus(exit.elapsed + instruction.cycles);
    load_rom_again(exit);
    host_.jump(done);
  });
}

void BlockEmitter::modify(const Instruction& instruction, Flags live) {
  const Operation operation = instruction.operation;
  const CarryHome carry = carry_;
  const bool counts = operation == Operation::inc || operation == Operation::dec;
  const ExitState before = exit_state();
  if (instruction.access == Access::Accumulator) {
    host_.shift_a(operation, carry, live);
    nz_ = NzHome::kA;
    carry_ = CarryHome::kNumber;
    return;
  }
  nz_ = NzHome::kNumber;
  if (instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute) {
    if (!is_ram(instruction.operand)) {
      settle(before);
      exit_before(instruction);
      return host_.forget_nz();
    }
    host_.modify_ram(instruction.operand & 0x7F, operation, carry, live);
  } else {
    Label outside;
    if (instruction.mode == Mode::zero_page_x)
      host_.offset_in_ram(instruction.operand, Reg::kX, outside);
    else
      host_.offset_in_ram_at(instruction.operand, Reg::kX, outside);
    exit_out_of_line(outside, instruction, before);
    host_.modify_ram_at_offset(operation, carry, live);
  }
  if (!counts) carry_ = CarryHome::kNumber;
}

}  // namespace racebeam::translator

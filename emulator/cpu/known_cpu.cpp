#include "emulator/cpu/known_cpu.hpp"

namespace racebeam {

using opcode::Mode;
using opcode::Operation;

// Pointers in memory are not followed.
unsigned KnownCpu::address(Mode mode) {
  switch (mode) {
    case Mode::zero_page: return fetch();
    case Mode::zero_page_x: return (fetch() + x_) & 0xFFU;
    case Mode::zero_page_y: return (fetch() + y_) & 0xFFU;
    case Mode::absolute: return fetch_word();
    case Mode::absolute_x: return (fetch_word() + x_) & 0xFFFFU;
    case Mode::absolute_y: return (fetch_word() + y_) & 0xFFFFU;
    default: throw Unknown{};
  }
}

std::uint8_t KnownCpu::operand(Mode mode) {
  return mode == Mode::immediate ? fetch() : bus_.read(address(mode));
}

// clang-format off
void KnownCpu::execute(const Opcode& opcode) {
  const Mode mode = opcode.mode;
  switch (opcode.operation) {
    case Operation::lda: return set(a_, operand(mode));
    case Operation::ldx: return set(x_, operand(mode));
    case Operation::ldy: return set(y_, operand(mode));
    case Operation::sta: return bus_.write(address(mode), a_);
    case Operation::stx: return bus_.write(address(mode), x_);
    case Operation::sty: return bus_.write(address(mode), y_);

    case Operation::tax: return set(x_, a_);
    case Operation::txa: return set(a_, x_);
    case Operation::tay: return set(y_, a_);
    case Operation::tya: return set(a_, y_);
    case Operation::tsx: return set(x_, sp_);
    case Operation::txs: sp_ = x_; return;

    case Operation::inx: return set(x_, static_cast<std::uint8_t>(x_ + 1));
    case Operation::dex: return set(x_, static_cast<std::uint8_t>(x_ - 1));
    case Operation::iny: return set(y_, static_cast<std::uint8_t>(y_ + 1));
    case Operation::dey: return set(y_, static_cast<std::uint8_t>(y_ - 1));
    case Operation::inc: return change(address(mode), 1);
    case Operation::dec: return change(address(mode), -1);

    case Operation::and_: return set(a_, a_ & operand(mode));
    case Operation::ora: return set(a_, a_ | operand(mode));
    case Operation::eor: return set(a_, a_ ^ operand(mode));
    case Operation::cmp: return compare(a_, operand(mode));
    case Operation::cpx: return compare(x_, operand(mode));
    case Operation::cpy: return compare(y_, operand(mode));

    case Operation::bne: return branch(!zero());
    case Operation::beq: return branch(zero());
    case Operation::bpl: return branch(!negative());
    case Operation::bmi: return branch(negative());
    case Operation::bcc: return branch(!known(carry_));
    case Operation::bcs: return branch(known(carry_));

    case Operation::pha: return push(a_);
    case Operation::pla: return set(a_, pull());
    case Operation::jmp: pc_ = static_cast<std::uint16_t>(address(mode)); return;
    case Operation::jsr: return call();
    case Operation::rts: return return_from_call();

    case Operation::clc: carry_ = false; return;
    case Operation::sec: carry_ = true; return;
    case Operation::sei: case Operation::cld: case Operation::clv: return;
    case Operation::nop: if (mode == Mode::implied) return; throw Unknown{};
    default: throw Unknown{};
  }
}
// clang-format on

}  // namespace racebeam

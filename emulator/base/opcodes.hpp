// The 256 opcodes as data: the rows of opcodes.inc, and the length of each instruction.
#pragma once

#include <array>
#include <cstdint>

namespace racebeam {
namespace opcode {

// Enumerators are named as in opcodes.inc.
// NOLINTBEGIN(readability-identifier-naming)
enum class Mode : std::uint8_t {
  implied,
  accumulator,
  relative,
  immediate,
  zero_page,
  zero_page_x,
  zero_page_y,
  absolute,
  absolute_x,
  absolute_y,
  indirect_x,
  indirect_y,
  indirect
};

enum class Operation : std::uint8_t {
  // documented
  adc,
  and_,
  asl,
  bcc,
  bcs,
  beq,
  bit,
  bmi,
  bne,
  bpl,
  brk,
  bvc,
  bvs,
  clc,
  cld,
  cli,
  clv,
  cmp,
  cpx,
  cpy,
  dec,
  dex,
  dey,
  eor,
  inc,
  inx,
  iny,
  jmp,
  jsr,
  lda,
  ldx,
  ldy,
  lsr,
  nop,
  ora,
  pha,
  php,
  pla,
  plp,
  rol,
  ror,
  rti,
  rts,
  sbc,
  sec,
  sed,
  sei,
  sta,
  stx,
  sty,
  tax,
  tay,
  tsx,
  txa,
  txs,
  tya,
  // undocumented
  anc,
  ane,
  arr,
  asr,
  dcp,
  isb,
  jam,
  las,
  lax,
  lxa,
  rla,
  rra,
  sax,
  sbx,
  sha,
  shs,
  shx,
  shy,
  slo,
  sre
};

// How the operation accesses memory: the fourth column of opcodes.inc.
enum class Access : std::uint8_t { Read, Immediate, Write, Modify, Accumulator, Implied, Jump, Branch };
// NOLINTEND(readability-identifier-naming)

// Bytes of an instruction that are fetched in order. JSR has two: it reads the high byte of its operand after
// its pushes.
constexpr std::uint8_t length(Operation operation, Mode mode) {
  if (operation == Operation::jsr) return 2;
  switch (mode) {
    case Mode::implied:
    case Mode::accumulator: return 1;
    case Mode::absolute:
    case Mode::absolute_x:
    case Mode::absolute_y:
    case Mode::indirect: return 3;
    default: return 2;
  }
}

}  // namespace opcode

struct Opcode {
  opcode::Operation operation;
  opcode::Mode mode;
  opcode::Access access;
  std::uint8_t length;
  std::uint8_t cycles;  // without those for crossed pages and taken branches
};

inline constexpr std::array<Opcode, 256> kOpcodes = {{
#define OP(code, operation, mode, access, cycles)                            \
  {opcode::Operation::operation, opcode::Mode::mode, opcode::Access::access, \
   opcode::length(opcode::Operation::operation, opcode::Mode::mode), cycles},
#include "emulator/base/opcodes.inc"
#undef OP
}};

}  // namespace racebeam

// One decoded 6502 instruction: the row of opcodes.inc, with its operand.
#pragma once

#include <cstdint>

namespace racebeam::translator {

// Enumerators are named as in opcodes.inc, which the interpreter's functions have to match, too.
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

struct Instruction {
  std::uint16_t pc;
  Operation operation;
  Mode mode;
  Access access;
  std::uint8_t length;
  std::uint8_t cycles;    // without those for crossed pages and taken branches
  std::uint16_t operand;  // one or two bytes, unsigned

  std::uint16_t next() const { return static_cast<std::uint16_t>(pc + length); }

  // The target of a branch, a JMP or a JSR.
  std::uint16_t target() const {
    if (access != Access::Branch) return operand;
    return static_cast<std::uint16_t>(next() + static_cast<std::int8_t>(operand));
  }
};

// Decodes the instruction at `pc`. Three bytes at `bytes` must be readable.
Instruction decode(const std::uint8_t* bytes, std::uint16_t pc);

// True for documented instructions except BRK, PLP and RTI. The interpreter executes all others.
bool is_translatable(const Instruction& instruction);

}  // namespace racebeam::translator

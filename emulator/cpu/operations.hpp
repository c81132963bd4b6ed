// The effect of each instruction on its operand (docs/spec/cpu.md, 6 to 9). The signature follows from the
// kind of access in opcodes.inc; names are the mnemonics there.
#pragma once

#include "emulator/cpu/core.hpp"
#include "emulator/cpu/decimal.hpp"

namespace racebeam::operation {

using Byte = std::uint8_t;
using Address = std::uint16_t;

RACEBEAM_INLINE Byte byte(int value) { return static_cast<Byte>(value); }

// Read: the argument is the operand.
RACEBEAM_INLINE void lda(Core& cpu, Byte m) { cpu.set_nz(cpu.A = m); }
RACEBEAM_INLINE void ldx(Core& cpu, Byte m) { cpu.set_nz(cpu.X = m); }
RACEBEAM_INLINE void ldy(Core& cpu, Byte m) { cpu.set_nz(cpu.Y = m); }
RACEBEAM_INLINE void lax(Core& cpu, Byte m) { cpu.set_nz(cpu.A = cpu.X = m); }
RACEBEAM_INLINE void ora(Core& cpu, Byte m) { cpu.set_nz(cpu.A |= m); }
RACEBEAM_INLINE void and_(Core& cpu, Byte m) { cpu.set_nz(cpu.A &= m); }
RACEBEAM_INLINE void eor(Core& cpu, Byte m) { cpu.set_nz(cpu.A ^= m); }
RACEBEAM_INLINE void nop(Core&, Byte) {}

RACEBEAM_INLINE void add_binary(Core& cpu, Byte m) {
  const int sum = cpu.A + m + cpu.C;
  cpu.V = byte((~(cpu.A ^ m) & (cpu.A ^ sum)) >> 7 & 1);
  cpu.C = byte(sum >> 8);
  cpu.set_nz(cpu.A = byte(sum));
}

RACEBEAM_INLINE void take_decimal(Core& cpu, Byte m, DecimalResult result) {
  cpu.V = byte(((cpu.A ^ result.value) & (result.value ^ m)) >> 7);
  cpu.C = result.carry;
  cpu.set_nz(cpu.A = result.value);
}

RACEBEAM_INLINE void adc(Core& cpu, Byte m) {
  if (cpu.D) [[unlikely]]
    take_decimal(cpu, m, add_decimal(cpu.A, m, cpu.C));
  else
    add_binary(cpu, m);
}

RACEBEAM_INLINE void sbc(Core& cpu, Byte m) {
  if (cpu.D) [[unlikely]]
    take_decimal(cpu, m, subtract_decimal(cpu.A, m, cpu.C));
  else
    add_binary(cpu, byte(~m));
}

RACEBEAM_INLINE void compare(Core& cpu, Byte reg, Byte m) {
  cpu.set_nz(byte(reg - m));
  cpu.C = reg >= m;
}
RACEBEAM_INLINE void cmp(Core& cpu, Byte m) { compare(cpu, cpu.A, m); }
RACEBEAM_INLINE void cpx(Core& cpu, Byte m) { compare(cpu, cpu.X, m); }
RACEBEAM_INLINE void cpy(Core& cpu, Byte m) { compare(cpu, cpu.Y, m); }

RACEBEAM_INLINE void bit(Core& cpu, Byte m) {
  cpu.set_nz(m, cpu.A & m);
  cpu.V = m >> 6 & 1;
}

RACEBEAM_INLINE void anc(Core& cpu, Byte m) {
  and_(cpu, m);
  cpu.C = cpu.A >> 7;
}
RACEBEAM_INLINE void asr(Core& cpu, Byte m) {
  const Byte w = cpu.A & m;
  cpu.C = w & 1;
  cpu.set_nz(cpu.A = w >> 1);
}
RACEBEAM_INLINE void arr(Core& cpu, Byte m) {
  const Byte w = cpu.A & m;
  const Byte rotated = byte(w >> 1 | cpu.C << 7);
  cpu.set_nz(rotated);
  if (!cpu.D) {
    cpu.A = rotated;
    cpu.C = rotated >> 6 & 1;
    cpu.V = (rotated >> 6 ^ rotated >> 5) & 1;
    return;
  }
  cpu.V = (w ^ rotated) >> 6 & 1;
  cpu.A = rotated;
  if ((w & 0x0F) + (w & 0x01) > 5) cpu.A = byte((cpu.A & 0xF0) | ((cpu.A + 6) & 0x0F));
  cpu.C = (w & 0xF0) + (w & 0x10) > 0x50;
  if (cpu.C) cpu.A = byte(cpu.A + 0x60);
}
RACEBEAM_INLINE void ane(Core& cpu, Byte m) { cpu.set_nz(cpu.A = (cpu.A | 0xEE) & cpu.X & m); }
RACEBEAM_INLINE void lxa(Core& cpu, Byte m) { cpu.set_nz(cpu.A = cpu.X = (cpu.A | 0xEE) & m); }
RACEBEAM_INLINE void sbx(Core& cpu, Byte m) {
  const int difference = (cpu.A & cpu.X) - m;
  cpu.set_nz(cpu.X = byte(difference));
  cpu.C = difference >= 0;
}
RACEBEAM_INLINE void las(Core& cpu, Byte m) { cpu.set_nz(cpu.A = cpu.X = cpu.SP = cpu.SP & m); }

// Write: the argument is the effective address, for the four that store a part of it. Returns the byte to
// store.
RACEBEAM_INLINE Byte high_plus_one(Address address) {
  return byte((address >> 8) + 1 > 0xFF ? 0 : (address >> 8) + 1);
}
RACEBEAM_INLINE Byte sta(Core& cpu, Address) { return cpu.A; }
RACEBEAM_INLINE Byte stx(Core& cpu, Address) { return cpu.X; }
RACEBEAM_INLINE Byte sty(Core& cpu, Address) { return cpu.Y; }
RACEBEAM_INLINE Byte sax(Core& cpu, Address) { return cpu.A & cpu.X; }
RACEBEAM_INLINE Byte sha(Core& cpu, Address address) { return cpu.A & cpu.X & high_plus_one(address); }
RACEBEAM_INLINE Byte shx(Core& cpu, Address address) { return cpu.X & high_plus_one(address); }
RACEBEAM_INLINE Byte shy(Core& cpu, Address address) { return cpu.Y & high_plus_one(address); }
RACEBEAM_INLINE Byte shs(Core& cpu, Address address) {
  cpu.SP = cpu.A & cpu.X;
  return cpu.SP & high_plus_one(address);
}

// Modify, and the same on A: the argument is the old byte. Returns the new one.
RACEBEAM_INLINE Byte asl(Core& cpu, Byte m) {
  cpu.C = m >> 7;
  m = byte(m << 1);
  cpu.set_nz(m);
  return m;
}
RACEBEAM_INLINE Byte lsr(Core& cpu, Byte m) {
  cpu.C = m & 1;
  m >>= 1;
  cpu.set_nz(m);
  return m;
}
RACEBEAM_INLINE Byte rol(Core& cpu, Byte m) {
  const Byte rotated = byte(m << 1 | cpu.C);
  cpu.C = m >> 7;
  cpu.set_nz(rotated);
  return rotated;
}
RACEBEAM_INLINE Byte ror(Core& cpu, Byte m) {
  const Byte rotated = byte(m >> 1 | cpu.C << 7);
  cpu.C = m & 1;
  cpu.set_nz(rotated);
  return rotated;
}
RACEBEAM_INLINE Byte inc(Core& cpu, Byte m) {
  cpu.set_nz(++m);
  return m;
}
RACEBEAM_INLINE Byte dec(Core& cpu, Byte m) {
  cpu.set_nz(--m);
  return m;
}
RACEBEAM_INLINE Byte slo(Core& cpu, Byte m) {
  m = asl(cpu, m);
  ora(cpu, m);
  return m;
}
RACEBEAM_INLINE Byte rla(Core& cpu, Byte m) {
  m = rol(cpu, m);
  and_(cpu, m);
  return m;
}
RACEBEAM_INLINE Byte sre(Core& cpu, Byte m) {
  m = lsr(cpu, m);
  eor(cpu, m);
  return m;
}
RACEBEAM_INLINE Byte rra(Core& cpu, Byte m) {
  m = ror(cpu, m);
  adc(cpu, m);
  return m;
}
RACEBEAM_INLINE Byte dcp(Core& cpu, Byte m) {
  cmp(cpu, --m);
  return m;
}
RACEBEAM_INLINE Byte isb(Core& cpu, Byte m) {
  sbc(cpu, ++m);
  return m;
}

// Implied.
RACEBEAM_INLINE void nop(Core&) {}
RACEBEAM_INLINE void clc(Core& cpu) { cpu.C = 0; }
RACEBEAM_INLINE void sec(Core& cpu) { cpu.C = 1; }
RACEBEAM_INLINE void cli(Core& cpu) { cpu.I = 0; }
RACEBEAM_INLINE void sei(Core& cpu) { cpu.I = 1; }
RACEBEAM_INLINE void cld(Core& cpu) { cpu.D = 0; }
RACEBEAM_INLINE void sed(Core& cpu) { cpu.D = 1; }
RACEBEAM_INLINE void clv(Core& cpu) { cpu.V = 0; }
RACEBEAM_INLINE void tax(Core& cpu) { cpu.set_nz(cpu.X = cpu.A); }
RACEBEAM_INLINE void tay(Core& cpu) { cpu.set_nz(cpu.Y = cpu.A); }
RACEBEAM_INLINE void txa(Core& cpu) { cpu.set_nz(cpu.A = cpu.X); }
RACEBEAM_INLINE void tya(Core& cpu) { cpu.set_nz(cpu.A = cpu.Y); }
RACEBEAM_INLINE void tsx(Core& cpu) { cpu.set_nz(cpu.X = cpu.SP); }
RACEBEAM_INLINE void txs(Core& cpu) { cpu.SP = cpu.X; }
RACEBEAM_INLINE void inx(Core& cpu) { cpu.set_nz(++cpu.X); }
RACEBEAM_INLINE void iny(Core& cpu) { cpu.set_nz(++cpu.Y); }
RACEBEAM_INLINE void dex(Core& cpu) { cpu.set_nz(--cpu.X); }
RACEBEAM_INLINE void dey(Core& cpu) { cpu.set_nz(--cpu.Y); }

// Branch: returns whether it is taken.
RACEBEAM_INLINE bool bpl(Core& cpu) { return !cpu.is_negative(); }
RACEBEAM_INLINE bool bmi(Core& cpu) { return cpu.is_negative(); }
RACEBEAM_INLINE bool bvc(Core& cpu) { return cpu.V == 0; }
RACEBEAM_INLINE bool bvs(Core& cpu) { return cpu.V != 0; }
RACEBEAM_INLINE bool bcc(Core& cpu) { return cpu.C == 0; }
RACEBEAM_INLINE bool bcs(Core& cpu) { return cpu.C != 0; }
RACEBEAM_INLINE bool bne(Core& cpu) { return !cpu.is_zero(); }
RACEBEAM_INLINE bool beq(Core& cpu) { return cpu.is_zero(); }

// Stack and jumps, in the order of accesses of docs/spec/cpu.md, 4.
RACEBEAM_INLINE void pha(Core& cpu) { cpu.push(cpu.A); }
RACEBEAM_INLINE void php(Core& cpu) { cpu.push(cpu.status()); }
RACEBEAM_INLINE void pla(Core& cpu) {
  cpu.read_stack();
  cpu.set_nz(cpu.A = cpu.pull());
}
RACEBEAM_INLINE void plp(Core& cpu) {
  cpu.read_stack();
  cpu.set_status(cpu.pull());
}
RACEBEAM_INLINE void jmp(Core& cpu, Address target) { cpu.jump(target); }
RACEBEAM_INLINE void jsr(Core& cpu, Address) {
  const Byte low = cpu.fetch();
  cpu.read_stack();
  cpu.push_one(byte(cpu.PC() >> 8), true);
  cpu.push_one(byte(cpu.PC() & 0xFF), false);
  cpu.jump(static_cast<Address>(low | cpu.read_at_PC() << 8));
}
RACEBEAM_INLINE void rts(Core& cpu, Address) {
  cpu.read_stack();
  const Byte low = cpu.pull();
  cpu.jump(static_cast<Address>(low | cpu.pull() << 8));
  cpu.read_at_PC();
  ++cpu.at;
}
RACEBEAM_INLINE void rti(Core& cpu, Address) {
  cpu.read_stack();
  cpu.set_status(cpu.pull());
  const Byte low = cpu.pull();
  cpu.jump(static_cast<Address>(low | cpu.pull() << 8));
}
RACEBEAM_INLINE void brk(Core& cpu, Address) {
  cpu.read_at_PC();
  ++cpu.at;
  cpu.push_one(byte(cpu.PC() >> 8), true);
  cpu.push_one(byte(cpu.PC() & 0xFF), false);
  cpu.push_one(cpu.status(), false);
  cpu.I = 1;
  const Byte low = cpu.read(0xFFFE);
  cpu.jump(static_cast<Address>(low | cpu.read(0xFFFF) << 8));
}

// The twelve opcodes that halt the CPU until a reset.
RACEBEAM_INLINE void jam(Core& cpu) {
  cpu.board.state.cpu.jammed = 1;
  cpu.end = 0;
}

}  // namespace racebeam::operation

// The effect of instructions on their operands: docs/spec/cpu.md, 6 to 8.
#include "tests/emulator/reference/reference_cpu.hpp"

namespace racebeam::test {
namespace {

int dec(int b) { return 10 * (b >> 4) + (b & 15); }
int bcd(int n) { return 16 * (n % 100 / 10) + n % 10; }

}  // namespace

// clang-format off
void ReferenceCpu::store(int name, int address) {
  const int h1 = (address >> 8) + 1;
  switch (name) {
    case op("sta"): return write(address, A);
    case op("stx"): return write(address, X);
    case op("sty"): return write(address, Y);
    case op("sax"): return write(address, A & X);
    case op("sha"): return write(address, A & X & h1);
    case op("shx"): return write(address, X & h1);
    case op("shy"): return write(address, Y & h1);
    default: SP = A & X; return write(address, SP & h1);  // shs
  }
}

int ReferenceCpu::modify(int name, int m) {
  const int c = C, up = (m << 1) & 0xFF, down = m >> 1;
  switch (name) {
    case op("asl"): C = m >> 7; nz(up); return up;
    case op("lsr"): C = m & 1; nz(down); return down;
    case op("rol"): C = m >> 7; nz(up | c); return up | c;
    case op("ror"): C = m & 1; nz(down | c << 7); return down | c << 7;
    case op("inc"): nz(m + 1); return (m + 1) & 0xFF;
    case op("dec"): nz(m - 1); return (m - 1) & 0xFF;
    case op("slo"): C = m >> 7; nz(A |= up); return up;
    case op("rla"): C = m >> 7; nz(A &= up | c); return up | c;
    case op("sre"): C = m & 1; nz(A ^= down); return down;
    case op("rra"): C = m & 1; adc(down | c << 7); return down | c << 7;
    case op("dcp"): compare(A, (m - 1) & 0xFF); return (m - 1) & 0xFF;
    default: sbc((m + 1) & 0xFF); return (m + 1) & 0xFF;  // isb
  }
}

void ReferenceCpu::use(int name, int m) {
  switch (name) {
    case op("lda"): return nz(A = m);
    case op("ldx"): return nz(X = m);
    case op("ldy"): return nz(Y = m);
    case op("lax"): return nz(A = X = m);
    case op("and"): return nz(A &= m);
    case op("ora"): return nz(A |= m);
    case op("eor"): return nz(A ^= m);
    case op("adc"): return adc(m);
    case op("sbc"): return sbc(m);
    case op("cmp"): return compare(A, m);
    case op("cpx"): return compare(X, m);
    case op("cpy"): return compare(Y, m);
    case op("bit"): Z = (A & m) == 0; N = m >> 7; V = m >> 6 & 1; return;
    case op("anc"): nz(A &= m); C = N; return;
    case op("asr"): A &= m; C = A & 1; nz(A >>= 1); return;
    case op("arr"): return arr(m);
    case op("ane"): return nz(A = (A | 0xEE) & X & m);
    case op("lxa"): return nz(A = X = (A | 0xEE) & m);
    case op("sbx"): C = (A & X) >= m; nz(X = ((A & X) - m) & 0xFF); return;
    case op("las"): return nz(A = X = SP = SP & m);
    default: return;  // nop
  }
}
// clang-format on

void ReferenceCpu::compare(int reg, int m) {
  nz(reg - m);
  Z = reg == m;
  C = reg >= m;
}

void ReferenceCpu::arr(int m) {
  const int w = A & m, c = C;
  A = w >> 1 | c << 7;
  nz(A);
  if (D == 0) {
    C = A >> 6 & 1;
    V = (A >> 6 ^ A >> 5) & 1;
    return;
  }
  N = c;
  V = (w >> 6 & 1) != (A >> 6 & 1);
  if ((w & 15) + (w & 1) > 5) A = (A & 0xF0) | ((A + 6) & 15);
  C = (w & 0xF0) + (w & 0x10) > 0x50;
  if (C) A = (A + 0x60) & 0xFF;
}

// Sections 7 and 8.
void ReferenceCpu::adc(int m) {
  const int before = A;
  if (D == 0) {
    const int sum = A + m + C;
    const int of_signed = static_cast<std::int8_t>(A) + static_cast<std::int8_t>(m) + C;
    V = of_signed < -128 || of_signed > 127;
    C = sum > 255;
    A = sum & 0xFF;
  } else {
    const int n = dec(A) + dec(m) + C;
    A = bcd(n % 256);
    C = n > 99;
    V = ((before ^ A) & (A ^ m)) >> 7 & 1;
  }
  nz(A);
}

void ReferenceCpu::sbc(int m) {
  if (D == 0) return adc(m ^ 0xFF);
  const int before = A, borrow = 1 - C;
  int n = dec(A) - dec(m) - borrow;
  if (n < 0) n += 100;
  A = n >= 0 ? bcd(n) : dec(256 + n);
  C = before >= m + borrow;
  V = ((before ^ A) & (A ^ m)) >> 7 & 1;
  nz(A);
}

}  // namespace racebeam::test

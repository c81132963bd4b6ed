// Encodes the instructions of AArch64 that translated code uses. Names and the order of operands are those of
// Arm's assembler language, except for words that C++ reserves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "emulator/translator/label.hpp"

namespace racebeam::translator::aarch64 {

// A register as an instruction names it: 32 bits wide (w0-w30), or 64 (x0-x30). Number 31 is zero, or SP
// where an address is based on it.
struct Register {
  unsigned number;
  bool is_wide;

  constexpr bool operator==(const Register&) const = default;
};

constexpr Register w(unsigned number) { return {number, false}; }
constexpr Register x(unsigned number) { return {number, true}; }
constexpr Register wzr = w(31), xzr = x(31), sp = x(31);

// NOLINTNEXTLINE(readability-identifier-naming): named as in Arm's language
enum class Condition : std::uint8_t { eq, ne, hs, lo, mi, pl, vs, vc, hi, ls, ge, lt, gt, le };

// Thrown if the memory is full, or a place is too far away for the instruction.
class AssemblyError : public std::length_error {
 public:
  using std::length_error::length_error;
};

class Encoder {
 public:
  Encoder(void* memory, std::size_t size);

  std::size_t size() const { return count_ * 4; }  // bytes written
  const void* here() const { return words_ + count_; }
  void bind(Label& label);
  const void* address_of(Label& label);  // once it is bound

  // Arithmetic and logic. `lsl` and `lsr` shift the last operand.
  void add(Register to, Register from, unsigned value);  // 12 bits, or 12 above 12 zeros
  void sub(Register to, Register from, unsigned value);
  void subs(Register to, Register from, unsigned value);
  void add(Register to, Register from, Register other, unsigned lsl = 0);
  void add_lsr(Register to, Register from, Register other, unsigned lsr);
  void sub(Register to, Register from, Register other, unsigned lsl = 0);
  void sub_lsr(Register to, Register from, Register other, unsigned lsr);
  void subs(Register to, Register from, Register other);
  void and_(Register to, Register from, unsigned mask);  // successive ones; 32 bits
  void orr(Register to, Register from, unsigned mask);
  void eor(Register to, Register from, unsigned mask);
  void tst(Register from, unsigned mask);
  void and_(Register to, Register from, Register other);
  void orr(Register to, Register from, Register other, unsigned lsl = 0);
  void orr_lsr(Register to, Register from, Register other, unsigned lsr);
  void eor(Register to, Register from, Register other);
  void cmp(Register from, unsigned value) { subs(zero_like(from), from, value); }
  void cmp(Register from, Register other) { subs(zero_like(from), from, other); }
  void mov(Register to, Register from) { orr(to, zero_like(to), from); }
  void mov(Register to, std::uint64_t value);  // in as many instructions as it needs
  void madd(Register to, Register a, Register b, Register addend);
  void ubfx(Register to, Register from, unsigned low, unsigned width);   // 32 bits
  void ubfiz(Register to, Register from, unsigned low, unsigned width);  // 32 bits
  void lsl(Register to, Register from, unsigned by) { ubfiz(to, from, by, 32 - by); }
  void lsr(Register to, Register from, unsigned by) { ubfx(to, from, by, 32 - by); }
  void cset(Register to, Condition condition);
  void csel(Register to, Register if_so, Register if_not, Condition condition);
  void cinc(Register to, Register from, Condition condition);

  // Memory. Offsets are in bytes: up to 4095 units, or from -256 to 255.
  void ldrb(Register to, Register base, int offset) { access(0, true, to, base, offset); }
  void ldrh(Register to, Register base, int offset) { access(1, true, to, base, offset); }
  void ldr(Register to, Register base, int offset) { access(to.is_wide ? 3 : 2, true, to, base, offset); }
  void strb(Register from, Register base, int offset) { access(0, false, from, base, offset); }
  void strh(Register from, Register base, int offset) { access(1, false, from, base, offset); }
  void str(Register from, Register base, int offset) {
    access(from.is_wide ? 3 : 2, false, from, base, offset);
  }
  void ldrb(Register to, Register base, Register index);      // [base, w index, uxtw]
  void ldr_lsl3(Register to, Register base, Register index);  // [base, w index, uxtw #3], 64 bits
  void str_post(Register from, Register base, int step);      // [base], #step; 32 bits
  void stp(Register first, Register second, Register base, int offset);
  void ldp(Register first, Register second, Register base, int offset);
  void stp_pre(Register first, Register second, Register base, int step);   // [base, #step]!
  void ldp_post(Register first, Register second, Register base, int step);  // [base], #step

  // Jumps
  void b(Label& label);
  void b(const void* code);
  void bl(const void* code);
  void b(Condition condition, Label& label);
  void cbz(Register reg, Label& label);
  void cbnz(Register reg, Label& label);
  void tbz(Register reg, unsigned bit, Label& label);
  void tbnz(Register reg, unsigned bit, Label& label);
  void br(Register reg);
  void blr(Register reg);
  void ret();

  static bool is_immediate(unsigned value);  // of add, sub, subs, cmp

 private:
  static constexpr Register zero_like(Register reg) { return {31, reg.is_wide}; }

  void emit(std::uint32_t word);
  void with_immediate(std::uint32_t opcode, Register to, Register from, unsigned value);
  void with_mask(std::uint32_t opcode, Register to, Register from, unsigned mask);
  void shifted(std::uint32_t opcode, Register to, Register from, Register other, unsigned lsl,
               unsigned lsr = 0);
  void access(unsigned size, bool loads, Register reg, Register base, int offset);
  void pair(std::uint32_t opcode, Register first, Register second, Register base, int offset);
  void jump(std::uint32_t word, Label& label);
  void set_distance(std::size_t at, std::ptrdiff_t words);

  // Instructions that jump to a label that is not bound yet.
  struct Target {
    std::ptrdiff_t place = -1;  // in words; -1: not bound
    std::vector<std::size_t> jumps;
  };

  std::uint32_t* words_;
  std::size_t capacity_, count_ = 0;
  LabelTable<Target> targets_;
};

}  // namespace racebeam::translator::aarch64

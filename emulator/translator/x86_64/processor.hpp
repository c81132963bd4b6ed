// What Host needs of the assembler. Registers:
//   rbx   Board*
//   ebp   the cycle, without those that are to be added (BlockEmitter::elapsed_)
//   r8d   N and Z as one number, see Context::nz
//   r9d   the carry, 0 or 1
//   r10   the window's ROM
//   r12d  A, r13d X, r14d Y, zero-extended
//   r15   WriteLog*
//   eax   address, SP or byte; ecx offset or latch; esi the data bus that is kept; edx, rsi pages and blocks
#pragma once

#include <cstdint>

#include "emulator/translator/x86_64/assembler.hpp"

namespace racebeam::translator::x86_64 {

class Processor {
 public:
  explicit Processor(Assembler& assembler) : as_(assembler) {}

 protected:
  using Reg8 = Xbyak::Reg8;
  using Reg32 = Xbyak::Reg32;
  enum class HostCarry : std::uint8_t {
    kUnknown,
    kSame,
    kInverted
  };  // whether the host's CF holds the carry

  static constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;

  static Reg32 reg_of(Reg reg) { return Reg32(Xbyak::Operand::R12 + static_cast<int>(reg)); }
  Xbyak::RegExp ram(unsigned offset) const { return as_.rbx + (as_.layout.ram + static_cast<int>(offset)); }
  Xbyak::RegExp place_of(const Value& value) const;
  template <class Apply>
  void with_operand(const Value& value, Apply apply);

  bool test_nz(NzHome home, bool sign);
  void branch_on_carry(bool if_set, Label& taken);
  void into_al(const Value& value);
  void carry_to_host(CarryHome carry, bool inverted);
  void carry_from_host(bool inverted, Flags live);
  void shift(Operation operation, Reg8 reg, CarryHome carry, Flags live);
  void modify(const Xbyak::RegExp& place, Operation operation, CarryHome carry, Flags live);
  Reg32 logged_value(unsigned reg, Reg value, Reg32 scratch);
  void clobbered_flags() { host_nz_ = false, host_carry_ = HostCarry::kUnknown; }
  template <class Function>
  void call(Function* function);

  Assembler& as_;
  HostCarry host_carry_ = HostCarry::kUnknown;
  bool host_nz_ = false;  // the host's ZF and SF equal Z and N
};

}  // namespace racebeam::translator::x86_64

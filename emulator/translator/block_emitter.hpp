// Translates one block of 6502 code to x86-64 (docs/translator.md).
//
// While translated code runs, registers hold the 6507's state:
//   rbx   Board*
//   ebp   the cycle at the block's start; `elapsed_` is to be added
//   r8d   N and Z as one number, see Context::nz
//   r9d   the carry, 0 or 1
//   r10   the window's ROM, if `rom_loaded_`
//   r12d  A, r13d X, r14d Y, zero-extended
//   r15   WriteLog*
// SP, V, D and I stay in memory.
#pragma once

#include <functional>
#include <vector>

#include "emulator/translator/assembler.hpp"
#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/liveness.hpp"

namespace racebeam::translator {

class BlockEmitter {
 public:
  BlockEmitter(Assembler& assembler, const Block& block);

  void emit();

 private:
  using Reg32 = Xbyak::Reg32;
  using Reg8 = Xbyak::Reg8;

  // An operand that is ready for use: a constant, a byte in memory, or al (zero-extended in eax).
  struct Value {
    enum class Kind { kConstant, kMemory, kEax } kind;
    std::uint8_t constant = 0;
    Xbyak::RegExp place = {};
  };

  enum class NzHome { kNumber, kA, kX, kY };            // r8d, or the register whose value they describe
  enum class CarryHome { kNumber, kClear, kSet };       // r9d, or known when translating
  enum class HostCarry { kUnknown, kSame, kInverted };  // whether the host's CF holds the carry

  // What is known at one point of the block. Code that exits from there needs it.
  struct ExitState {
    int elapsed;
    NzHome nz;
    CarryHome carry;
    bool rom_loaded;
  };

  // block_emitter.cpp: flow
  void emit(const Instruction& instruction, Flags live);
  void emit_read(const Instruction& instruction, Flags live);
  void emit_branch(const Instruction& instruction);
  void emit_jump(const Instruction& instruction);
  void jsr(const Instruction& instruction);
  void return_to_cartridge(const Instruction& instruction, Xbyak::Label& interpret);
  bool can_jump_to(std::uint16_t target) const;
  void rts(const Instruction& instruction);
  void jmp_indirect(const Instruction& instruction);
  void find_block(Xbyak::Label& none);
  void jump_to_block(const Instruction& instruction);
  void jump_to(std::uint16_t target);
  void jump_to_other_batch(std::uint16_t target);
  void check_limit();
  void exit_before(const Instruction& instruction);  // The interpreter executes it. Call this in cold code.
  void settle(const ExitState& exit);                // brings cycle and flags into their registers
  void exit_out_of_line(Xbyak::Label label, const Instruction& instruction, const ExitState& exit);
  ExitState exit_state() const { return {elapsed_, nz_, carry_, rom_loaded_}; }
  void cold(std::function<void()> emit) { cold_.push_back(std::move(emit)); }

  // block_values.cpp: operations on registers and values
  void load(Reg32 to, const Value& value, NzHome home);
  void logic(const Instruction& instruction, const Value& value);
  void add(const Instruction& instruction, Value value, Flags live);
  void compare(Reg8 reg, const Value& value, Flags live);
  void bit(const Value& value, Flags live);
  void implied(const Instruction& instruction, Flags live);
  void modify(const Instruction& instruction, Flags live);
  void shift(Operation operation, const Xbyak::Operand& operand, Flags live);
  void push(const Instruction& instruction);
  void pull(const Instruction& instruction);
  void into_al(const Value& value);
  void carry_to_host(bool inverted);
  void carry_from_host(bool inverted, Flags live);
  void made_nz(NzHome home, bool host_flags) { nz_ = home, host_nz_ = host_flags; }
  void clobbered_flags() { host_nz_ = false, host_carry_ = HostCarry::kUnknown; }

  // block_ports.cpp: reads of the TIA's pins, and of ports of the cartridge
  Value read_pin(const Instruction& instruction, unsigned latch);
  Value read_port(const Instruction& instruction, PortReader reader);
  void fetch(std::uint16_t address);

  // block_reads.cpp and block_writes.cpp: memory accesses
  Value read(const Instruction& instruction);
  Value read_fixed(const Instruction& instruction);
  Value read_zero_page_indexed(const Instruction& instruction, Reg32 index);
  Value read_indexed(const Instruction& instruction, Reg32 index);
  Value read_through_pointer(const Instruction& instruction);
  bool load_pointer(const Instruction& instruction);
  void read_at_eax(const Instruction& instruction);
  void read_device(const Instruction& instruction, const ExitState& exit);
  void add_penalty(const Instruction& instruction, Reg32 index);
  void remove_penalty(const Instruction& instruction);
  void load_rom();
  void load_rom_again();
  void write(const Instruction& instruction);
  void write_fixed(const Instruction& instruction, Reg32 value);
  void append(const Instruction& instruction, unsigned reg, Reg32 value);
  void touch_tia(int cycles);
  void write_sound(const Instruction& instruction, unsigned reg, Reg32 value);
  void write_hmclr(const Instruction& instruction, Reg32 value);
  void write_register(const Instruction& instruction, unsigned reg, Reg32 value);
  void write_wsync(const Instruction& instruction);
  void write_zero_page_indexed(const Instruction& instruction, Xbyak::Reg64 index, Reg32 value);
  void write_at_eax(const Instruction& instruction, Reg32 value);
  void call_write(const Instruction& instruction, Reg32 value, const ExitState& exit);

  Assembler& as_;
  const Block& block_;
  std::vector<std::function<void()>> cold_;
  int elapsed_ = 0;  // cycles that are not in ebp yet
  NzHome nz_ = NzHome::kNumber;
  CarryHome carry_ = CarryHome::kNumber;
  HostCarry host_carry_ = HostCarry::kUnknown;
  bool host_nz_ = false;  // the host's ZF and SF equal Z and N
  bool rom_loaded_ = false;
};

}  // namespace racebeam::translator

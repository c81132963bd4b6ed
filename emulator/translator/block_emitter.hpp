// Plans the translation of a block of 6502 code, for any host processor (docs/translator.md): which accesses
// need the bus, what is known about the flags, and which code is out of line. Host emits the code.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/host.hpp"
#include "emulator/translator/liveness.hpp"

namespace racebeam::translator {

class BlockEmitter {
 public:
  BlockEmitter(Assembler& assembler, const Block& block);

  void emit();

 private:
  // What is known at one point of the block, for code that exits there.
  struct ExitState {
    int elapsed;
    NzHome nz;
    CarryHome carry;
    bool rom_loaded;
  };
  static constexpr ExitState kSettled{0, NzHome::kNumber, CarryHome::kNumber, false};

  // block_emitter.cpp: flow
  void emit(const Instruction& instruction, Flags live);
  void emit_read(const Instruction& instruction, Flags live);
  void emit_branch(const Instruction& instruction);
  void emit_jump(const Instruction& instruction);
  void jsr(const Instruction& instruction);
  bool can_jump_to(std::uint16_t target) const;
  void rts(const Instruction& instruction);
  void jmp_indirect(const Instruction& instruction);
  void jump_to(std::uint16_t target);
  void jump_to_other_batch(std::uint16_t target);
  void skip_timer_loop(const Instruction& instruction, int penalty);
  void check_limit();
  void exit_before(const Instruction& instruction);  // the interpreter executes it; only for out-of-line code
  void settle(const ExitState& exit);                // brings cycle and flags into their registers
  void exit_out_of_line(Label label, const Instruction& instruction, const ExitState& exit);
  ExitState exit_state() const { return {elapsed_, nz_, carry_, rom_loaded_}; }
  int cycles_to(const Instruction& instruction) const { return elapsed_ + instruction.cycles; }  // to its end
  void cold(std::function<void()> emit) { cold_.push_back(std::move(emit)); }

  // block_values.cpp: operations on registers and values
  void add(const Instruction& instruction, const Value& value, Flags live);
  void implied(const Instruction& instruction);
  void modify(const Instruction& instruction, Flags live);
  void push(const Instruction& instruction);
  void pull(const Instruction& instruction);

  // block_reads.cpp and block_writes.cpp: memory accesses
  Value read(const Instruction& instruction);
  Value read_fixed(const Instruction& instruction);
  Value read_port(const Instruction& instruction, PortReader reader);
  void fetch(std::uint16_t address);
  Value read_zero_page_indexed(const Instruction& instruction, Reg index);
  Value read_indexed(const Instruction& instruction, Reg index);
  Value read_ram_or_device(const Instruction& instruction, Reg index);
  Value read_through_pointer(const Instruction& instruction);
  bool load_pointer(const Instruction& instruction);
  void read_at_address(const Instruction& instruction);
  void read_device(const Instruction& instruction, const ExitState& exit);
  void add_penalty(const Instruction& instruction, Reg index);
  void remove_penalty(const Instruction& instruction);
  void load_rom();
  void load_rom_again(const ExitState& exit);
  void write(const Instruction& instruction);
  void write_fixed(const Instruction& instruction, Reg value);
  void write_wsync(const Instruction& instruction);
  void write_zero_page_indexed(const Instruction& instruction, Reg index, Reg value);
  void write_at_address(const Instruction& instruction, Reg value);
  void call_write(const Instruction& instruction, const ExitState& exit);

  Assembler& as_;
  Host host_;
  const Block& block_;
  std::vector<std::function<void()>> cold_;
  int elapsed_ = 0;  // cycles that are not in the register yet
  NzHome nz_ = NzHome::kNumber;
  CarryHome carry_ = CarryHome::kNumber;
  bool rom_loaded_ = false;
};

}  // namespace racebeam::translator

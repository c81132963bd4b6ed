// The 6507's registers while instructions run, and its way to the bus. Everything is inlined into run() in cpu.cpp,
// so that the registers are locals of one function.
#pragma once

#include <cstdint>

#include "emulator/board.hpp"
#include "emulator/inlining.hpp"
#include "emulator/timer_loop.hpp"

namespace racebeam {

// An address below $0100: RAM from $80 on, registers of the TIA before it.
struct ZeroPage {
  std::uint8_t at;

  operator std::uint16_t() const { return at; }
};

struct Core {
  Board& board;
  std::int32_t cycle;      // T: at the end of the instruction from its second bus access on (cpu.md, section 3)
  std::int32_t budget;     // instructions still to run
  std::uint32_t at;        // PC, counted from the start of the code window
  std::uint8_t A, X, Y, SP;
  std::uint32_t nz;        // N is bit 15 or bit 7; Z is set when bits 7-0 are 0
  std::uint8_t C, V, D, I; // 0 or 1
  std::uint8_t latch;      // the data bus after the last access
  const std::uint8_t* code = nullptr;  // the bytes of the instruction that runs

  explicit Core(Board& on, std::int32_t instructions)
      : board(on), cycle(on.state.cycle), budget(instructions), A(on.state.cpu.A), X(on.state.cpu.X),
        Y(on.state.cpu.Y), SP(on.state.cpu.SP), latch(on.state.cpu.latch) {
    jump(on.state.cpu.PC);
    set_status(on.state.cpu.P);
  }

  RACEBEAM_INLINE std::uint16_t PC() const { return static_cast<std::uint16_t>(board.code.first + at); }
  RACEBEAM_INLINE void jump(std::uint16_t target) { at = static_cast<std::uint16_t>(target - board.code.first); }

  RACEBEAM_INLINE void store_state() const {
    board.state.cycle = cycle;
    CpuState& cpu = board.state.cpu;
    cpu.PC = PC();
    cpu.A = A;
    cpu.X = X;
    cpu.Y = Y;
    cpu.SP = SP;
    cpu.P = status() & 0xCF;
    cpu.latch = latch;
  }

  // The status byte as it is pushed: bits 5 and 4 are always 1.
  RACEBEAM_INLINE std::uint8_t status() const {
    return static_cast<std::uint8_t>(is_negative() << 7 | V << 6 | 0x30 | D << 3 | I << 2 | is_zero() << 1 | C);
  }

  RACEBEAM_INLINE void set_status(std::uint8_t p) {
    V = p >> 6 & 1;
    D = p >> 3 & 1;
    I = p >> 2 & 1;
    C = p & 1;
    set_nz(p, ~p & 2);
  }

  RACEBEAM_INLINE void set_nz(std::uint8_t value) { nz = value; }
  RACEBEAM_INLINE void set_nz(std::uint8_t negative, std::uint32_t nonzero) { nz = (negative & 0x80U) << 8 | nonzero; }
  RACEBEAM_INLINE bool is_negative() const { return (nz & 0x8080) != 0; }
  RACEBEAM_INLINE bool is_zero() const { return (nz & 0xFF) == 0; }

  RACEBEAM_INLINE std::uint8_t read(std::uint16_t address) {
    const std::uint8_t* page = board.map.page_of(address);
    latch = page != nullptr ? page[address & 0x3F] : board.read_device(address, latch, cycle);
    return latch;
  }

  RACEBEAM_INLINE std::uint8_t read(ZeroPage address) {
    if (address.at < 0x80) return read(std::uint16_t{address.at});
    return latch = board.state.riot.ram[address.at - 0x80U];
  }

  // The instruction at PC: its bytes, wherever they are.
  RACEBEAM_INLINE unsigned fetch_opcode() {
    if (at < board.code.span) [[likely]] code = board.code.memory + at;
    else locate_code();
    return code[0];
  }

  RACEBEAM_INLINE void locate_code() {
    const std::uint16_t pc = PC();
    code = board.locate_code(pc, latch, cycle);
    jump(pc);
  }

  // It has been fetched: its cycles up to the end but penalties.
  RACEBEAM_INLINE void begin(std::uint8_t opcode, std::int32_t base_cycles) {
    latch = opcode;
    ++at;
    cycle += base_cycles;
  }

  // Its operand.
  RACEBEAM_INLINE std::uint8_t fetch() {
    ++at;
    return latch = code[1];
  }

  RACEBEAM_INLINE std::uint16_t fetch_word() {
    at += 2;
    latch = code[2];
    return static_cast<std::uint16_t>(code[1] | latch << 8);
  }

  // A byte that is read when its turn comes, like any other.
  RACEBEAM_INLINE std::uint8_t read_at_PC() { return read(PC()); }

  // At the end of a taken branch that may close a timer loop: goes on before the last turn. One turn is left to be run
  // in any case, for what it leaves in the registers.
  RACEBEAM_INLINE void skip_timer_loop(std::int32_t period) {
    if (at >= board.code.span || budget < 4) return;
    const std::int32_t sure = sure_timer_turns(code, board.state.riot, cycle + 4, period), most = budget / 2 - 1;
    const std::int32_t turns = sure < most ? sure : most;
    cycle += turns * period;
    budget -= 2 * turns;
  }

  RACEBEAM_INLINE void write(ZeroPage address, std::uint8_t value) {
    if (address.at >= 0x80) {
      board.state.riot.ram[address.at - 0x80U] = value;
    } else {
      write_device(address.at, value);
    }
    latch = value;
  }

  RACEBEAM_INLINE void write(std::uint16_t address, std::uint8_t value) {
    if ((address & 0x1280) == 0x0080) {
      board.state.riot.ram[address & 0x7F] = value;
    } else {
      write_device(address, value);
    }
    latch = value;
  }

  RACEBEAM_INLINE void write_device(std::uint16_t address, std::uint8_t value) {
    if ((address & 0x1080) == 0 && board.is_plain_write(address, cycle)) {
      board.log->append_change(cycle, address & 0x3F, value);
    } else {
      cycle = board.write_device(address, value, cycle, true);
      if (board.stop) budget = 0;
    }
  }

  // after_read: the CPU access before this one was a read, which WSYNC asks for.
  // Two pushes can reach the TIA in one cycle, where the first one's delay holds up the second: both are kept.
  RACEBEAM_INLINE void push(std::uint8_t value, bool after_read = true) {
    const std::uint16_t address = 0x0100 | SP--;
    latch = value;
    if (address & 0x80) {
      board.state.riot.ram[address & 0x7F] = value;
      return;
    }
    cycle = board.write_device(address, value, cycle, after_read);
    if (board.stop) budget = 0;
  }

  RACEBEAM_INLINE std::uint8_t pull() { return read(0x0100 | ++SP); }
  RACEBEAM_INLINE void read_stack_dummy() { read(0x0100 | SP); }
};

}  // namespace racebeam

// The 6507's registers while instructions run, and its access to the bus. Everything is inlined into
// interpret() in cpu.cpp, so that the registers are locals of one function.
#pragma once

#include <cstdint>

#include "emulator/base/inlining.hpp"
#include "emulator/base/opcodes.hpp"
#include "emulator/board/board.hpp"
#include "emulator/cpu/timer_loop.hpp"

namespace racebeam {

// An address below $0100: the TIA's registers, and RAM from $80 on.
struct ZeroPage {
  std::uint8_t at;

  operator std::uint16_t() const { return at; }
};

struct Core {
  Board& board;
  // cycle() and executed() in one number, so that an instruction counts both with one addition.
  std::int64_t clock;
  std::uintptr_t at;          // PC, as an address in the host's memory
  std::uintptr_t start, end;  // of the code window; end is 0 if locate() must find the next instruction
  std::uintptr_t origin;      // the host's address of address 0
  std::int32_t budget;        // instructions that may be executed
  std::int32_t enough;        // from this count on, it stops at the next instruction that checks
  bool stays;                 // it stops where it leaves the code window
  std::uint32_t nz;           // N is bit 15 or bit 7; Z is set when bits 7-0 are 0
  std::uint8_t A, X, Y, SP;
  std::uint8_t C, V, D, I;  // 0 or 1
  std::uint8_t latch;       // the data bus after the last access
  bool counted = false;     // the alarm bit has been seen

  static constexpr int kCycleBit = 24;
  static constexpr std::int64_t kCycle = 1 << kCycleBit;

  // The alarm bit of the clock is set when the budget might end before the next jump; no run without a jump
  // is longer than a window. From then on, locate() counts. Before, only jumps and branches test the bit, and
  // whatever else adds instructions to the clock.
  static constexpr std::int64_t kAlarm = 1 << (kCycleBit - 1);
  static constexpr std::int32_t kLongestRow = 4096;

  Core(Board& on, std::int32_t most, std::int32_t at_least, bool stay)
      : board(on),
        budget(most),
        enough(at_least),
        stays(stay),
        A(on.state.cpu.A),
        X(on.state.cpu.X),
        Y(on.state.cpu.Y),
        SP(on.state.cpu.SP),
        latch(on.state.cpu.latch) {
    clock = on.state.cycle * kCycle + kAlarm - (budget - kLongestRow);
    take_window();
    jump(on.state.cpu.PC);
    end = 0;
    set_status(on.state.cpu.P);
  }

  // T in docs/spec/cpu.md, 3. From an instruction's second bus access on, it is the cycle at its end.
  RACEBEAM_INLINE std::int32_t cycle() const { return static_cast<std::int32_t>(clock >> kCycleBit); }

  // Adds a cycle if bit 8 of `carry` is set.
  RACEBEAM_INLINE void add_penalty(std::uint32_t carry) { clock += (carry & 0x100) * (kCycle >> 8); }
  RACEBEAM_INLINE void set_cycle(std::int32_t cycle) { clock = (clock & (kCycle - 1)) + cycle * kCycle; }
  RACEBEAM_INLINE std::int32_t executed() const {
    return static_cast<std::int32_t>((clock & (kCycle - 1)) - kAlarm) + (budget - kLongestRow);
  }

  RACEBEAM_INLINE static const std::uint8_t* byte_at(std::uintptr_t where) {
    return reinterpret_cast<const std::uint8_t*>(where);  // NOLINT(performance-no-int-to-ptr): of place()
  }
  RACEBEAM_INLINE static std::uintptr_t place(const std::uint8_t* byte) {
    return reinterpret_cast<std::uintptr_t>(byte);
  }

  RACEBEAM_INLINE void take_window() {
    start = place(board.code.memory);
    origin = start - board.code.first;
    end = counted ? 0 : place(board.code.end);
  }

  RACEBEAM_INLINE std::uint16_t PC() const { return static_cast<std::uint16_t>(at - origin); }
  RACEBEAM_INLINE void jump(std::uint16_t target) {
    at = start + static_cast<std::uint16_t>(target - static_cast<std::uint16_t>(start - origin));
    check_budget();
  }

  // Returns the cycles beyond those of a branch that is not taken.
  RACEBEAM_INLINE int branch(std::int8_t offset) {
    const auto next = static_cast<std::uint32_t>(at - origin);
    at += static_cast<std::uintptr_t>(std::intptr_t{offset});
    const auto target = static_cast<std::uint32_t>(at - origin);
    const std::uint32_t crosses = (next ^ target) & 0x100;
    clock += kCycle;
    add_penalty(crosses);
    if (at < start) [[unlikely]]
      end = 0;
    check_budget();
    return crosses == 0 ? 1 : 2;
  }

  RACEBEAM_INLINE void check_budget() {
    if (clock & kAlarm) [[unlikely]]
      end = 0;
  }

  // After an access to a device: the window may have changed, or the frame may have closed.
  RACEBEAM_INLINE void check_window() {
    if (board.code.end == nullptr) end = 0;
  }

  // Finds the next instruction at any address. Returns false if no instruction is to be executed.
  RACEBEAM_INLINE bool locate() {
    counted = (clock & kAlarm) != 0;
    if (board.stop || board.state.cpu.jammed || (counted && executed() >= enough)) return false;
    const std::uint16_t pc = PC(), offset = static_cast<std::uint16_t>(pc - board.code.first);
    if (stays && offset >= board.code.span && board.code.span != 0 && executed() > 0) return false;
    at = place(offset < board.code.span ? board.code.memory + offset : board.locate_code(pc, latch, cycle()));
    take_window();
    return true;
  }

  RACEBEAM_INLINE void store_state() const {
    board.state.cycle = cycle();
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
    return static_cast<std::uint8_t>(is_negative() << 7 | V << 6 | 0x30 | D << 3 | I << 2 | is_zero() << 1 |
                                     C);
  }

  RACEBEAM_INLINE void set_status(std::uint8_t p) {
    V = p >> 6 & 1;
    D = p >> 3 & 1;
    I = p >> 2 & 1;
    C = p & 1;
    set_nz(p, ~p & 2);
  }

  RACEBEAM_INLINE void set_nz(std::uint8_t value) { nz = value; }
  RACEBEAM_INLINE void set_nz(std::uint8_t negative, std::uint32_t nonzero) {
    nz = (negative & 0x80U) << 8 | nonzero;
  }
  RACEBEAM_INLINE bool is_negative() const { return (nz & 0x8080) != 0; }
  RACEBEAM_INLINE bool is_zero() const { return (nz & 0xFF) == 0; }

  RACEBEAM_INLINE std::uint8_t read(std::uint16_t address) {
    const std::uint8_t* page = board.map.page_of(address);
    if (page == nullptr) [[unlikely]]
      return read_device(address);
    return latch = page[address & 0x3F];
  }

  RACEBEAM_INLINE std::uint8_t read(ZeroPage address) {
    if (address.at < 0x80) [[unlikely]]
      return read(std::uint16_t{address.at});
    return latch = board.state.riot.ram[address.at - 0x80U];
  }

  RACEBEAM_INLINE std::uint16_t read_word_of_ram(unsigned zero_page) {
    return word(&board.state.riot.ram[zero_page - 0x80U]);
  }

  RACEBEAM_INLINE std::uint8_t read_device(std::uint16_t address) {
    latch = board.read_device(address, latch, cycle());
    check_window();
    return latch;
  }

  // Starts an instruction that has been found. base_cycles: without penalties.
  RACEBEAM_INLINE void begin(std::uint8_t opcode, std::int32_t base_cycles) {
    latch = opcode;
    at += kOpcodes[opcode].length;
    clock += base_cycles * kCycle + 1;
  }

  // Returns the operand of the instruction, if it is one byte; fetch_word(), if it is two.
  RACEBEAM_INLINE std::uint8_t fetch() { return latch = byte_at(at)[-1]; }
  RACEBEAM_INLINE std::uint16_t fetch_word() { return word(byte_at(at) - 2); }

  // Returns two consecutive bytes as a number. The second one stays on the data bus.
  RACEBEAM_INLINE std::uint16_t word(const std::uint8_t* bytes) {
    const auto both = static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
    latch = static_cast<std::uint8_t>(both >> 8);
    return both;
  }

  // Reads the byte at PC over the bus.
  RACEBEAM_INLINE std::uint8_t read_at_PC() { return read(PC()); }

  // At the end of a taken branch that may close a timer loop: skips all iterations but the last. The last one
  // is executed for its effect on the registers. Code without a jump may follow it, so the budget is looked
  // at here.
  RACEBEAM_INLINE void skip_timer_loop(std::int32_t period) {
    if (at >= end) return;
    const std::uint8_t* code = byte_at(at) + 3;  // the branch instruction
    const std::int32_t sure = sure_timer_turns(code, board.state.riot, cycle() + 4, period);
    const std::int32_t most = (budget - executed()) / 2 - 1;
    const std::int32_t turns = sure < most ? sure : most;
    clock += turns * (period * kCycle + 2);
    check_budget();
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
    if ((address & board.ram_select_bits) == 0x0080) {
      board.state.riot.ram[address & 0x7F] = value;
    } else {
      write_device(address, value);
    }
    latch = value;
  }

  RACEBEAM_INLINE void write_device(std::uint16_t address, std::uint8_t value) {
    std::int32_t now = cycle();
    if ((address & 0x1080) != 0) [[unlikely]]
      return write_slowly(address, value, true);
    if (board.is_plain_write(address, now)) return board.log->append_change(now, address & 0x3F, value);
    if (board.wait_for_line(address, now)) return set_cycle(now);
    write_slowly(address, value, true);
  }

  RACEBEAM_INLINE void write_slowly(std::uint16_t address, std::uint8_t value, bool after_read) {
    set_cycle(board.write_device(address, value, cycle(), after_read));
    check_window();
  }

  // Where the stack pointer is in the TIA, games write registers this way.
  RACEBEAM_INLINE void push(std::uint8_t value) { write(static_cast<std::uint16_t>(0x0100 | SP--), value); }

  // One of several bytes that an instruction pushes. Two of them can reach the TIA in one cycle, where the
  // delay of the first holds up the second: both are kept. after_read: the previous access was a read, on
  // which WSYNC depends.
  RACEBEAM_INLINE void push_one(std::uint8_t value, bool after_read) {
    const std::uint16_t address = 0x0100 | SP--;
    latch = value;
    if (address & 0x80) {
      board.state.riot.ram[address & 0x7F] = value;
      return;
    }
    write_slowly(address, value, after_read);
  }

  RACEBEAM_INLINE std::uint8_t pull() {
    ++SP;
    return read_stack();
  }
  RACEBEAM_INLINE std::uint8_t read_stack() {
    if (SP < 0x80) [[unlikely]]
      return read(0x0100 | SP);
    return latch = board.state.riot.ram[SP - 0x80U];
  }
};

}  // namespace racebeam

// The interface between the planner of blocks (block_emitter.hpp) and the code generators. For each host
// processor, a folder defines these functions, which emit code, and a class Processor, which has its
// assembler.
//
// Between two instructions, registers hold the 6507's A, X and Y, the cycle, N and Z as one number
// (Context::nz), and the carry. SP, V, D and I stay in memory. Within an instruction, further registers hold:
//   address  of an access
//   offset   in RAM: the address without bit 7
//   latch    what is on the data bus before a read, or the value of a write
//   byte     what has been read
// Some of these share a register: a function that sets one may overwrite the others, unless its comment says
// otherwise.
#pragma once

#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/translator/instruction.hpp"
#include "emulator/translator/liveness.hpp"

namespace racebeam::translator {

enum class Reg : std::uint8_t { kA, kX, kY };
enum class NzHome : std::uint8_t { kA, kX, kY, kNumber };       // the register whose value N and Z describe
enum class CarryHome : std::uint8_t { kNumber, kClear, kSet };  // or its value, if known at translation

// Where the value of an operand is.
struct Value {
  enum class Kind : std::uint8_t {
    kConstant,  // `number`
    kRam,       // the byte of RAM at the offset `number`
    kPage,      // byte `number` of the page of load_page()
    kTable,     // the window's byte at the offset `number` and `index`
    kByte       // the register `byte`
  } kind;
  unsigned number = 0;
  Reg index = Reg::kA;
};

}  // namespace racebeam::translator

#if defined(__aarch64__)
#include "emulator/translator/aarch64/processor.hpp"
namespace racebeam::translator {
namespace target = aarch64;
}
#else
#include "emulator/translator/x86_64/processor.hpp"
namespace racebeam::translator {
namespace target = x86_64;
}
#endif

namespace racebeam::translator {

using target::Assembler, target::AssemblyError;

class Host : private target::Processor {
 public:
  using Processor::Processor;

  // flow.cpp: labels and jumps. `leave` ends translated code, with a PC and perhaps kInterpretNext.
  enum class Distance : std::uint8_t { kShort, kNear };
  void bind(Label& label);
  void jump(Label& label);
  void jump(const void* code);
  void jump_through(const void* const* entry, Label& absent);  // to `absent` if *entry is null
  void jump_at_limit(Label& reached, Distance distance);
  void branch(Operation operation, NzHome nz, Label& taken);  // for BCC and BCS, the carry is a number
  void leave(std::uint32_t exit);
  void add_cycles(int cycles);
  void make_nz(NzHome home);  // makes N and Z a number
  void make_carry(bool set);

  // flow.cpp: jumps to an address in memory. find_block() finds the block at the address, if that is in the
  // window.
  void push_return_address(std::uint16_t address, Label& outside);
  void load_return_address(Label& interpret);
  void drop_return_address();
  void load_jump_address(unsigned pointer);
  void find_block(Label& absent);  // jumps to `absent` if there is no block, or at the limit
  void jump_to_found_block(int cycles);
  void leave_to_return_address(int cycles, Label& interpret);  // jumps if that is not in the cartridge

  // values.cpp: registers and flags. live: the flags that must be correct afterwards.
  void load(Reg to, const Value& value);
  void logic(Operation operation, const Value& value);
  void add(bool subtracts, const Value& value, CarryHome carry, Flags live, Label& decimal);
  void add_decimal(bool subtracts, const Value& value, CarryHome carry);
  void compare(Reg reg, const Value& value, Flags live);
  void bit(const Value& value, Flags live);
  void transfer(Reg to, Reg from);
  void step(Reg reg, int by);  // 1 or -1
  void shift_a(Operation operation, CarryHome carry, Flags live);
  void modify_ram(unsigned offset, Operation operation, CarryHome carry, Flags live);
  void modify_ram_at_offset(Operation operation, CarryHome carry, Flags live);
  void carry_became_known();
  void forget_nz();                                   // the host's flags do not hold N and Z any more
  void store(std::int32_t place, std::uint8_t byte);  // at an offset in the Board

  // values.cpp: the stack
  void transfer_sp_to_x();
  void transfer_x_to_sp();
  void load_sp();
  void load_status();                     // sets the latch to the status byte; SP remains loaded
  void push(bool status, Label& device);  // pushes A or the status, after load_sp()
  void push_to_device(bool status);       // sets address and latch after push() went to `device`
  void pull(Label& outside);              // into A
  void pull_over_bus(int cycles);

  // reads.cpp: addresses
  void load_address(std::uint16_t address);
  void load_latch(std::uint8_t byte);
  void index_address(unsigned base, Reg index);  // 17 bits
  void wrap_address();                           // to 16 bits
  void load_pointer(unsigned pointer);           // the address
  void load_pointer_at_x(unsigned pointer, Label& outside);
  void add_y();                                                          // to the address: 17 bits
  void add_y_with_penalty();                                             // to the address: 16 bits
  void offset_in_ram(unsigned zero_page, Reg index, Label& device);      // zero page, indexed
  void offset_in_ram_at(std::uint16_t base, Reg index, Label& outside);  // absolute, indexed
  void address_of_device();                                              // of an offset that is not in RAM
  void add_cycle_if(Reg index, int least);
  void remove_cycle_if(Reg index, int least);
  void remove_cycle_of_pointer(unsigned pointer);

  // reads.cpp: reads into `byte`, except for load_page()
  void load_rom();  // must precede read_window() and the use of kTable
  void load_page(std::uint16_t address, Label& hidden);
  void read_ram();                     // at the offset
  void keep_bus(std::uint8_t byte);    // keeps the data bus before read_window(), for latch_kept_bus()
  void keep_bus_of_pointer();          // keeps the address's high byte
  void read_window(Label& elsewhere);  // keeps the address if it is elsewhere
  void read_page(Label& device);       // keeps the address if it is a device's
  void jump_if_cartridge(Label& cartridge);
  void latch_kept_bus();
  void read_bus(int cycles);  // at the address
  void read_pin(int pin, unsigned undriven, int cycles);
  void read_port(PortReader reader, std::uint16_t address, int cycles);
  void fetch(std::uint16_t address, Label& enters, Label& leaves, Label& done);

  // writes.cpp
  void write_ram(unsigned offset, Reg value);
  void write_ram_at_offset(Reg value);
  void write_ram_at_address(Reg value, Label& device);
  void latch_value(Reg value);
  void write_bus(int cycles, Label& leaves);  // writes the latch at the address
  void touch_tia(int cycles);
  void write_sound(unsigned reg, Reg value);
  void forget_motion();  // the write log no longer knows the motion registers
  void append(unsigned reg, Reg value, int cycles);
  void append_change(unsigned reg, Reg value, int cycles);
  void wait_for_line(int cycles);

  // calls.cpp
  void skip_timer_loop(const std::uint8_t* branch, int period);
};

// A flag in the result of translated code: the interpreter must execute the instruction at PC. The low 16
// bits of the result are the PC.
constexpr std::uint32_t kInterpretNext = 1U << 16;

}  // namespace racebeam::translator

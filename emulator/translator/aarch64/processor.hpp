// The AArch64 assembler of one batch of blocks, and the functions that Host needs.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "emulator/translator/aarch64/encoder.hpp"
#include "emulator/translator/layout.hpp"
#include "emulator/translator/stubs.hpp"
#include "emulator/translator/window.hpp"

namespace racebeam::translator::aarch64 {

// Calls preserve these registers. A, X and Y have zeros above bit 7.
constexpr Register kBoard = x(19), kLog = x(20), kA = w(21), kX = w(22), kY = w(23), kCycle = w(24),
                   kNz = w(25), kCarry = w(26), kRom = x(27), kLimit = w(28);

// These are used within an instruction. The first four are also the arguments of calls, and w0 has their
// result.
constexpr Register kByte = w(0), kAddress = w(1), kLatch = w(2), kTime = w(3), kOffset = w(4), kTarget = w(6);
constexpr Register kPage = x(5), kBlock = x(7), kPlace = x(8);  // pointers
constexpr Register kScratch = w(16), kOther = w(17), kPointer = x(16);

class Assembler : public Encoder {
 public:
  // Writes to `memory`.
  Assembler(void* memory, std::size_t size, const Layout& places, const Window& seen, const Stubs& shared)
      : Encoder(memory, size), layout(places), window(seen), stubs(shared) {}

  const Layout& layout;
  const Window& window;
  const Stubs& stubs;
  std::unordered_map<std::uint16_t, Label> blocks;  // labels of this batch's blocks, by address

  const void* address_of(std::uint16_t block) { return Encoder::address_of(blocks[block]); }
};

class Processor {
 public:
  explicit Processor(Assembler& assembler) : as_(assembler) {}

 protected:
  enum class NzForm : std::uint8_t {
    kAny,    // of Context::nz
    kPlain,  // N is bit 7, and the bits above are 0
    kWord    // N is bit 15
  };

  static constexpr Register reg_of(Reg reg) { return w(kA.number + static_cast<unsigned>(reg)); }

  // Add a constant of any size and sign, or compare with one. A constant of more than 12 bits uses kScratch.
  void add_constant(Register to, Register from, int value);
  void compare_with(Register reg, unsigned value);

  Register operand(const Value& value);  // the value's register; otherwise it is loaded into kScratch
  void ram_at(Register index);           // kPlace + layout.ram is the byte of RAM at `index`
  Register logged_value(unsigned reg, Reg value, Register scratch);
  void keep_byte(Register reg) { as_.and_(reg, reg, 0xFFU); }
  void branch_on_sign(NzHome home, bool if_set, Label& taken);
  void branch_on_zero(NzHome home, bool if_set, Label& taken);
  void shift(Operation operation, Register reg, CarryHome carry, Flags live);
  void rotate(Operation operation, Register reg, CarryHome carry, Flags live);
  void modify(Register base, int offset, Operation operation, CarryHome carry, Flags live);
  void compare_with_ram(Register address);  // the condition eq then means: it is in RAM
  template <class Function>
  void call(Function* function);

  Assembler& as_;
  NzForm nz_form_ = NzForm::kAny;  // the form of the number
};

}  // namespace racebeam::translator::aarch64

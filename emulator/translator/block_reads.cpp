// Emits reads. The more is known of an address at translation, the shorter is the code.
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/bus_calls.hpp"

namespace racebeam::translator {
namespace {

constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;

constexpr std::uint8_t high_byte(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); }

}  // namespace

BlockEmitter::Value BlockEmitter::read(const Instruction& instruction) {
  // clang-format off
  switch (instruction.mode) {
    case Mode::immediate: return {Value::Kind::kConstant, static_cast<std::uint8_t>(instruction.operand)};
    case Mode::zero_page: case Mode::absolute: return read_fixed(instruction);
    case Mode::zero_page_x: return read_zero_page_indexed(instruction, as_.r13d);
    case Mode::zero_page_y: return read_zero_page_indexed(instruction, as_.r14d);
    case Mode::absolute_x: return read_indexed(instruction, as_.r13d);
    case Mode::absolute_y: return read_indexed(instruction, as_.r14d);
    default: return read_through_pointer(instruction);
  }
  // clang-format on
}

BlockEmitter::Value BlockEmitter::read_fixed(const Instruction& instruction) {
  const std::uint16_t address = instruction.operand;
  if (is_ram(address)) return {Value::Kind::kMemory, 0, as_.rbx + (as_.layout.ram + (address & 0x7F))};
  if (const PortReader reader = as_.window.port_reader(address)) return read_port(instruction, reader);
  if (!is_cartridge(address)) {
    // the last byte on the data bus was the operand's
    const unsigned latch = instruction.length == 3 ? high_byte(address) : address;
    if (is_pin(address) && !as_.window.cartridge_watches()) return read_pin(instruction, latch);
    as_.mov(as_.eax, address);
    as_.mov(as_.ecx, latch);
    read_device(instruction, exit_state());
    return {Value::Kind::kEax};
  }
  if (as_.covers(address)) return {Value::Kind::kConstant, as_.byte_at(address)};
  Xbyak::Label hidden;
  as_.mov(as_.rdx, as_.ptr[as_.rbx + as_.layout.pages + 8 * (address >> 6 & 0xFF)]);
  as_.test(as_.rdx, as_.rdx);
  as_.jz(hidden, kNear);
  exit_out_of_line(hidden, instruction, exit_state());
  clobbered_flags();
  return {Value::Kind::kMemory, 0, as_.rdx + (address & 0x3F)};
}

// Reads the TIA or the RIOT, in line. Inputs as for call_read, in eax and ecx. If the cartridge watches these
// addresses, the interpreter executes the read: the cartridge may have memory there, or switch banks.
void BlockEmitter::read_device(const Instruction& instruction, const ExitState& exit) {
  if (as_.window.cartridge_watches()) {
    remove_penalty(instruction);
    settle(exit);
    exit_before(instruction);
    return;
  }
  as_.lea(as_.edx, as_.ptr[as_.rbp + (exit.elapsed + instruction.cycles)]);
  call_read(as_);
  if (exit.rom_loaded) load_rom_again();
  clobbered_flags();
}

BlockEmitter::Value BlockEmitter::read_zero_page_indexed(const Instruction& instruction, Reg32 index) {
  Xbyak::Label device, done;
  as_.lea(as_.ecx, as_.ptr[index.cvt64() + (instruction.operand - 0x80)]);
  as_.movzx(as_.ecx, as_.cl);
  as_.test(as_.cl, as_.cl);
  as_.js(device, kNear);
  as_.movzx(as_.eax, as_.byte[as_.rbx + as_.rcx + as_.layout.ram]);
  as_.L(done);
  clobbered_flags();
  cold([this, instruction, exit = exit_state(), device, done]() mutable {
    as_.L(device);
    as_.mov(as_.eax, as_.ecx);
    as_.xor_(as_.eax, 0x80);
    as_.mov(as_.ecx, instruction.operand);
    read_device(instruction, exit);
    as_.jmp(done, kNear);
  });
  return {Value::Kind::kEax};
}

// A table within the window is read without a check of the address.
BlockEmitter::Value BlockEmitter::read_indexed(const Instruction& instruction, Reg32 index) {
  const std::uint16_t base = instruction.operand;
  if (is_cartridge(base) && as_.covers(base, 256)) {
    add_penalty(instruction, index);
    load_rom();
    return {Value::Kind::kMemory, 0, as_.r10 + index.cvt64() + as_.offset_of(base)};
  }
  as_.lea(as_.eax, as_.ptr[index.cvt64() + base]);
  as_.movzx(as_.eax, as_.ax);
  add_penalty(instruction, index);
  as_.mov(as_.esi, high_byte(base));
  read_at_eax(instruction);
  return {Value::Kind::kEax};
}

BlockEmitter::Value BlockEmitter::read_through_pointer(const Instruction& instruction) {
  if (!load_pointer(instruction)) return {Value::Kind::kConstant};
  as_.mov(as_.esi, as_.eax);
  as_.shr(as_.esi, 8);
  if (instruction.mode == Mode::indirect_y) {
    as_.movzx(as_.ecx, as_.al);
    as_.add(as_.cl, as_.r14b);
    as_.adc(as_.ebp, 0);
    as_.add(as_.eax, as_.r14d);
    as_.movzx(as_.eax, as_.ax);
  }
  clobbered_flags();
  read_at_eax(instruction);
  return {Value::Kind::kEax};
}

// Loads the pointer of (zp),Y or (zp,X) into eax. Returns false if it is not in RAM; the interpreter then
// executes the instruction.
bool BlockEmitter::load_pointer(const Instruction& instruction) {
  if (instruction.mode == Mode::indirect_y) {
    if (instruction.operand < 0x80 || instruction.operand == 0xFF) {
      settle(exit_state());
      exit_before(instruction);
      return false;
    }
    as_.movzx(as_.eax, as_.word[as_.rbx + (as_.layout.ram + (instruction.operand & 0x7F))]);
    return true;
  }
  Xbyak::Label outside;
  as_.lea(as_.ecx, as_.ptr[as_.r13 + (instruction.operand - 0x80)]);
  as_.movzx(as_.ecx, as_.cl);
  as_.cmp(as_.ecx, 0x7F);
  as_.jae(outside, kNear);
  as_.movzx(as_.eax, as_.word[as_.rbx + as_.rcx + as_.layout.ram]);
  exit_out_of_line(outside, instruction, exit_state());
  clobbered_flags();
  return true;
}

// Reads the byte at the address in eax, into eax. Input: esi the data bus before. The penalty for a crossed
// page has been added already. The common case is a table in the window's ROM.
void BlockEmitter::read_at_eax(const Instruction& instruction) {
  Xbyak::Label elsewhere, done;
  load_rom();
  as_.lea(as_.ecx, as_.ptr[as_.rax - as_.window.code.first]);
  as_.cmp(as_.ecx, as_.size());
  as_.jae(elsewhere, kNear);
  as_.movzx(as_.eax, as_.byte[as_.r10 + as_.rcx]);
  as_.L(done);
  clobbered_flags();
  cold([this, instruction, exit = exit_state(), elsewhere, done]() mutable {
    Xbyak::Label device, cartridge;
    as_.L(elsewhere);
    as_.mov(as_.ecx, as_.eax);
    as_.shr(as_.ecx, 6);
    as_.movzx(as_.ecx, as_.cl);
    as_.mov(as_.rdx, as_.ptr[as_.rbx + as_.rcx * 8 + as_.layout.pages]);
    as_.test(as_.rdx, as_.rdx);
    as_.jz(device, kNear);
    as_.and_(as_.eax, 0x3F);
    as_.movzx(as_.eax, as_.byte[as_.rdx + as_.rax]);
    as_.jmp(done, kNear);
    as_.L(device);
    as_.test(as_.ah, 0x10);
    as_.jnz(cartridge, kNear);
    as_.mov(as_.ecx, as_.esi);
    read_device(instruction, exit);
    as_.jmp(done, kNear);
    as_.L(cartridge);
    remove_penalty(instruction);
    settle(exit);
    exit_before(instruction);
  });
}

// Adds a cycle if the index crosses a page.
void BlockEmitter::add_penalty(const Instruction& instruction, Reg32 index) {
  const int low = instruction.operand & 0xFF;
  if (low == 0) return;
  as_.cmp(index.cvt8(), 256 - low);
  as_.sbb(as_.ebp, -1);
  clobbered_flags();
}

void BlockEmitter::remove_penalty(const Instruction& instruction) {
  const int low = instruction.operand & 0xFF;
  switch (instruction.mode) {
    case Mode::absolute_x:
    case Mode::absolute_y:
      if (low == 0) return;
      as_.cmp(instruction.mode == Mode::absolute_x ? as_.r13b : as_.r14b, 256 - low);
      as_.adc(as_.ebp, -1);
      break;
    case Mode::indirect_y:
      as_.movzx(as_.ecx, as_.ram(instruction.operand));
      as_.add(as_.cl, as_.r14b);
      as_.sbb(as_.ebp, 0);
      break;
    default: break;
  }
}

void BlockEmitter::load_rom() {
  if (!rom_loaded_) load_rom_again();
  rom_loaded_ = true;
}

void BlockEmitter::load_rom_again() {
  as_.mov(as_.r10, reinterpret_cast<std::uintptr_t>(as_.window.code.memory));
}

}  // namespace racebeam::translator

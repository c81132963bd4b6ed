// Emits writes: to RAM, to the write log, and to devices.
#include <cstddef>

#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/bus_calls.hpp"

namespace racebeam::translator {
namespace {

constexpr auto kNear = Xbyak::CodeGenerator::T_NEAR;

}  // namespace

void BlockEmitter::write(const Instruction& instruction) {
  const Reg32 value = instruction.operation == Operation::sta   ? as_.r12d
                      : instruction.operation == Operation::stx ? as_.r13d
                                                                : as_.r14d;
  const auto index = [&] { return instruction.mode == Mode::absolute_x ? as_.r13 : as_.r14; };
  // clang-format off
  switch (instruction.mode) {
    case Mode::zero_page: case Mode::absolute: write_fixed(instruction, value); return;
    case Mode::zero_page_x: write_zero_page_indexed(instruction, as_.r13, value); return;
    case Mode::zero_page_y: write_zero_page_indexed(instruction, as_.r14, value); return;
    case Mode::absolute_x: case Mode::absolute_y:
      as_.lea(as_.eax, as_.ptr[index() + instruction.operand]);
      break;
    default:
      if (!load_pointer(instruction)) return;
      if (instruction.mode == Mode::indirect_y) as_.add(as_.eax, as_.r14d);
      break;
  }
  // clang-format on
  write_at_eax(instruction, value);
}

void BlockEmitter::write_fixed(const Instruction& instruction, Reg32 value) {
  const std::uint16_t address = instruction.operand;
  if (is_ram(address)) {
    as_.mov(as_.ram(address), value.cvt8());
    return;
  }
  const unsigned reg = address & 0x3F;
  if (is_tia(address) && (as_.window.plain_registers >> reg & 1) != 0)
    return write_register(instruction, reg, value);
  const bool is_free = is_tia(address) && !as_.window.cartridge_watches();
  if (is_free && reg == WSYNC) return write_wsync(instruction);
  if (is_free && reg == HMCLR) return write_hmclr(instruction, value);
  if (is_free && is_sound(reg)) return write_sound(instruction, reg, value);
  if (is_free && reg >= kTiaRegisters) return touch_tia(elapsed_ + instruction.cycles);
  as_.mov(as_.eax, address);
  call_write(instruction, value, exit_state());
}

// A TIA address without a register: only the cycle of the access counts.
void BlockEmitter::touch_tia(int cycles) {
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  as_.mov(as_.dword_of(as_.layout.last_access), as_.edx);
}

// Sound::write, in line.
void BlockEmitter::write_sound(const Instruction& instruction, unsigned reg, Reg32 value) {
  as_.mov(as_.byte_of(as_.layout.sound + static_cast<int>(reg - AUDC0)), value.cvt8());
  touch_tia(elapsed_ + instruction.cycles);
}

// WriteLog::append for HMCLR, in line. The log then knows no values of the motion registers.
void BlockEmitter::write_hmclr(const Instruction& instruction, Reg32 value) {
  static_assert(HMP1 == HMP0 + 1 && HMM0 == HMP0 + 2 && HMM1 == HMP0 + 3 && HMBL == HMP0 + 4);
  constexpr int kFirst = offsetof(WriteLog, written) + 2 * HMP0;
  for (const int at : {0, 4})
    as_.mov(as_.dword[as_.r15 + (kFirst + at)], WriteLog::kUnknown << 16 | WriteLog::kUnknown);
  as_.mov(as_.word[as_.r15 + (kFirst + 8)], WriteLog::kUnknown);
  append(instruction, HMCLR, value);
  clobbered_flags();
}

// WriteLog::append_change, in line.
void BlockEmitter::write_register(const Instruction& instruction, unsigned reg, Reg32 value) {
  if ((kPictureRegisters >> reg & 1) == 0) return;
  const auto written = [](unsigned of) { return static_cast<int>(offsetof(WriteLog, written) + 2 * of); };
  const Xbyak::Reg16 word_value(value.getIdx());
  Xbyak::Label repeated;
  if (WriteLog::kOnRepeat[reg] == 0) {
    const unsigned other = kRegisters[reg].renews;
    if (other != kNone) as_.movzx(as_.edx, as_.word[as_.r15 + written(reg)]);
    as_.cmp(as_.word[as_.r15 + written(reg)], word_value);
    as_.je(repeated);
    as_.mov(as_.word[as_.r15 + written(reg)], word_value);
    if (other != kNone) {
      Xbyak::Label same_value;
      as_.and_(as_.edx, WriteLog::kUnknown | 0xFF);
      as_.cmp(as_.edx, value);
      as_.je(same_value);
      as_.or_(as_.byte[as_.r15 + written(other) + 1], WriteLog::kUnsettled >> 8);
      as_.L(same_value);
    }
  }
  append(instruction, reg, value);
  as_.L(repeated);
  clobbered_flags();
}

// Appends cycle, register and value, as a TiaWrite.
void BlockEmitter::append(const Instruction& instruction, unsigned reg, Reg32 value) {
  as_.lea(as_.ecx, as_.ptr[as_.rbp + (elapsed_ + instruction.cycles)]);
  as_.sub(as_.ecx, as_.dword[as_.r15 + offsetof(WriteLog, base)]);
  as_.shl(as_.ecx, TiaWrite::kCycleShift);
  as_.lea(as_.ecx, as_.ptr[as_.rcx + value.cvt64() + static_cast<int>(reg << 8)]);
  as_.mov(as_.rdx, as_.ptr[as_.r15 + offsetof(WriteLog, next)]);
  as_.mov(as_.ptr[as_.rdx], as_.ecx);
  as_.add(as_.qword[as_.r15 + offsetof(WriteLog, next)], sizeof(std::uint32_t));
}

// Waits for the end of the line: a division by 76, exact for cycles below 69,000. The limit is far below.
void BlockEmitter::write_wsync(const Instruction& instruction) {
  const int cycles = elapsed_ + instruction.cycles;
  as_.mov(as_.ecx, as_.dword_of(as_.layout.first_line));
  as_.lea(as_.eax, as_.ptr[as_.rbp + (cycles + 75)]);
  as_.sub(as_.eax, as_.ecx);
  as_.imul(as_.eax, as_.eax, 55189);
  as_.shr(as_.eax, 22);
  as_.imul(as_.eax, as_.eax, 76);
  as_.add(as_.eax, as_.ecx);
  touch_tia(cycles);
  as_.mov(as_.ebp, as_.eax);
  as_.sub(as_.eax, as_.edx);
  as_.add(as_.dword_of(as_.layout.waited), as_.eax);
  elapsed_ = -static_cast<int>(instruction.cycles);  // emit() adds them after the instruction
  clobbered_flags();
}

void BlockEmitter::write_zero_page_indexed(const Instruction& instruction, Xbyak::Reg64 index, Reg32 value) {
  Xbyak::Label device, done;
  as_.lea(as_.ecx, as_.ptr[index + (instruction.operand - 0x80)]);
  as_.movzx(as_.ecx, as_.cl);
  as_.test(as_.cl, as_.cl);
  as_.js(device, kNear);
  as_.mov(as_.byte[as_.rbx + as_.rcx + as_.layout.ram], value.cvt8());
  as_.L(done);
  clobbered_flags();
  cold([this, instruction, value, exit = exit_state(), device, done]() mutable {
    as_.L(device);
    as_.mov(as_.eax, as_.ecx);
    as_.xor_(as_.eax, 0x80);
    call_write(instruction, value, exit);
    as_.jmp(done, kNear);
  });
}

void BlockEmitter::write_at_eax(const Instruction& instruction, Reg32 value) {
  Xbyak::Label device, done;
  as_.mov(as_.ecx, as_.eax);
  as_.and_(as_.ecx, 0x1280);
  as_.cmp(as_.ecx, 0x80);
  as_.jne(device, kNear);
  as_.and_(as_.eax, 0x7F);
  as_.mov(as_.byte[as_.rbx + as_.rax + as_.layout.ram], value.cvt8());
  as_.L(done);
  clobbered_flags();
  cold([this, instruction, value, exit = exit_state(), device, done]() mutable {
    as_.L(device);
    as_.movzx(as_.eax, as_.ax);
    call_write(instruction, value, exit);
    as_.jmp(done, kNear);
  });
}

// Writes to a device or the cartridge, at the address in eax. The write may end the frame, or change what the
// window shows.
void BlockEmitter::call_write(const Instruction& instruction, Reg32 value, const ExitState& exit) {
  const int cycles = exit.elapsed + instruction.cycles;
  Xbyak::Label leaves;
  if (value.getIdx() != as_.ecx.getIdx()) as_.mov(as_.ecx, value);
  as_.lea(as_.edx, as_.ptr[as_.rbp + cycles]);
  call_write_bus(as_);
  as_.lea(as_.ebp, as_.ptr[as_.rax - cycles]);
  as_.cmp(as_.byte_of(as_.layout.stop), 0);
  as_.jne(leaves, kNear);
  as_.cmp(as_.word[as_.rbx + as_.layout.code_span], 0);
  as_.je(leaves, kNear);
  if (exit.rom_loaded) load_rom_again();
  clobbered_flags();
  cold([this, instruction, exit, cycles, leaves]() mutable {
    as_.L(leaves);
    ExitState after = exit;
    after.elapsed = cycles;
    settle(after);
    as_.mov(as_.eax, instruction.next());
    as_.jmp(as_.exit_stub, kNear);
  });
}

}  // namespace racebeam::translator

// Plans writes: to RAM, to the write log, and to devices.
#include "emulator/tia/registers/registers.hpp"
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"

namespace racebeam::translator {

void BlockEmitter::write(const Instruction& instruction) {
  const Reg value = instruction.operation == Operation::sta   ? Reg::kA
                    : instruction.operation == Operation::stx ? Reg::kX
                                                              : Reg::kY;
  // clang-format off
  switch (instruction.mode) {
    case Mode::zero_page: case Mode::absolute: write_fixed(instruction, value); return;
    case Mode::zero_page_x: write_zero_page_indexed(instruction, Reg::kX, value); return;
    case Mode::zero_page_y: write_zero_page_indexed(instruction, Reg::kY, value); return;
    case Mode::absolute_x: host_.index_address(instruction.operand, Reg::kX); break;
    case Mode::absolute_y: host_.index_address(instruction.operand, Reg::kY); break;
    default:
      if (!load_pointer(instruction)) return;
      if (instruction.mode == Mode::indirect_y) host_.add_y();
      break;
  }
  // clang-format on
  write_at_address(instruction, value);
}

void BlockEmitter::write_fixed(const Instruction& instruction, Reg value) {
  const std::uint16_t address = instruction.operand;
  if (is_ram(address)) return host_.write_ram(address & 0x7F, value);
  const unsigned reg = address & 0x3F;
  const int cycles = cycles_to(instruction);
  if (is_tia(address) && (as_.window.plain_registers >> reg & 1) != 0) {
    if ((kPictureRegisters >> reg & 1) != 0) host_.append_change(reg, value, cycles);
    return;
  }
  const bool is_free = is_tia(address) && !as_.window.cartridge_watches();
  if (is_free && reg == WSYNC) return write_wsync(instruction);
  if (is_free && reg == HMCLR) {
    host_.forget_motion();
    return host_.append(reg, value, cycles);
  }
  if (is_free && is_sound(reg)) {
    host_.write_sound(reg, value);
    return host_.touch_tia(cycles);
  }
  if (is_free && reg >= kTiaRegisters) return host_.touch_tia(cycles);  // only the access's cycle matters
  host_.load_address(address);
  host_.latch_value(value);
  call_write(instruction, exit_state());
}

// Waits for the end of the line.
void BlockEmitter::write_wsync(const Instruction& instruction) {
  host_.wait_for_line(cycles_to(instruction));
  elapsed_ = -static_cast<int>(instruction.cycles);  // emit() adds them after the instruction
}

void BlockEmitter::write_zero_page_indexed(const Instruction& instruction, Reg index, Reg value) {
  Label device, done;
  host_.offset_in_ram(instruction.operand, index, device);
  host_.write_ram_at_offset(value);
  host_.bind(done);
  cold([this, instruction, value, exit = exit_state(), device, done]() mutable {
    host_.bind(device);
    host_.address_of_device();
    host_.latch_value(value);
    call_write(instruction, exit);
    host_.jump(done);
  });
}

void BlockEmitter::write_at_address(const Instruction& instruction, Reg value) {
  Label device, done;
  host_.write_ram_at_address(value, device);
  host_.bind(done);
  cold([this, instruction, value, exit = exit_state(), device, done]() mutable {
    host_.bind(device);
    host_.wrap_address();
    host_.latch_value(value);
    call_write(instruction, exit);
    host_.jump(done);
  });
}

// Writes the latch to a device or the cartridge, at `address`. The write may end the frame, or change the
// bank in the window.
void BlockEmitter::call_write(const Instruction& instruction, const ExitState& exit) {
  const int cycles = exit.elapsed + instruction.cycles;
  Label leaves;
  host_.write_bus(cycles, leaves);
  load_rom_again(exit);
  cold([this, instruction, exit, cycles, leaves]() mutable {
    host_.bind(leaves);
    settle({cycles, exit.nz, exit.carry, exit.rom_loaded});
    host_.leave(instruction.next());
  });
}

}  // namespace racebeam::translator

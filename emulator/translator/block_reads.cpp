// Plans reads. The more is known about an address at translation, the shorter the code is.
#include <cstddef>

#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/translator/addresses.hpp"
#include "emulator/translator/block_emitter.hpp"

namespace racebeam::translator {
namespace {

constexpr std::uint8_t high_byte(std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); }

}  // namespace

Value BlockEmitter::read(const Instruction& instruction) {
  // clang-format off
  switch (instruction.mode) {
    case Mode::immediate: return {Value::Kind::kConstant, instruction.operand};
    case Mode::zero_page: case Mode::absolute: return read_fixed(instruction);
    case Mode::zero_page_x: return read_zero_page_indexed(instruction, Reg::kX);
    case Mode::zero_page_y: return read_zero_page_indexed(instruction, Reg::kY);
    case Mode::absolute_x: return read_indexed(instruction, Reg::kX);
    case Mode::absolute_y: return read_indexed(instruction, Reg::kY);
    default: return read_through_pointer(instruction);
  }
  // clang-format on
}

Value BlockEmitter::read_fixed(const Instruction& instruction) {
  const std::uint16_t address = instruction.operand;
  if (is_ram(address)) return {Value::Kind::kRam, address & 0x7FU};
  if (const PortReader reader = as_.window.port_reader(address)) return read_port(instruction, reader);
  if (!is_cartridge(address)) {
    // the last byte on the data bus was the operand's
    const std::uint8_t latch =
        instruction.length == 3 ? high_byte(address) : static_cast<std::uint8_t>(address);
    if (is_pin(address) && !as_.window.cartridge_watches()) {
      host_.read_pin(address & 7, latch & 0x3FU, cycles_to(instruction));
    } else {
      host_.load_address(address);
      host_.load_latch(latch);
      read_device(instruction, exit_state());
    }
    return {Value::Kind::kByte};
  }
  if (as_.window.covers(address)) return {Value::Kind::kConstant, as_.window.byte_at(address)};
  Label hidden;
  host_.load_page(address, hidden);
  exit_out_of_line(hidden, instruction, exit_state());
  return {Value::Kind::kPage, address & 0x3FU};
}

Value BlockEmitter::read_port(const Instruction& instruction, PortReader reader) {
  if (as_.window.port_reader_at == dpc::port_reader && dpc::is_plain_fetch(instruction.operand)) {
    fetch(instruction.operand);
  } else {
    host_.read_port(reader, instruction.operand, cycles_to(instruction));
    load_rom_again(exit_state());
  }
  return {Value::Kind::kByte};
}

void BlockEmitter::fetch(std::uint16_t address) {
  Label enters, leaves, done;
  host_.fetch(address, enters, leaves, done);
  cold([this, address, enters, leaves, done]() mutable {
    const std::int32_t flag = as_.layout.in_fetcher(address, offsetof(dpc::Fetcher, flag));
    host_.bind(enters);
    host_.store(flag, 0xFF);
    host_.jump(done);
    host_.bind(leaves);
    host_.store(flag, 0x00);
    host_.jump(done);
  });
}

// Reads the TIA or the RIOT at `address`. If the cartridge watches these addresses, the interpreter executes
// the read: the cartridge may have memory there, or switch banks.
void BlockEmitter::read_device(const Instruction& instruction, const ExitState& exit) {
  if (as_.window.cartridge_watches()) {
    remove_penalty(instruction);
    settle(exit);
    return exit_before(instruction);
  }
  host_.read_bus(exit.elapsed + instruction.cycles);
  load_rom_again(exit);
}

Value BlockEmitter::read_zero_page_indexed(const Instruction& instruction, Reg index) {
  Label device, done;
  host_.offset_in_ram(instruction.operand, index, device);
  host_.read_ram();
  host_.bind(done);
  cold([this, instruction, exit = exit_state(), device, done]() mutable {
    host_.bind(device);
    host_.address_of_device();
    host_.load_latch(static_cast<std::uint8_t>(instruction.operand));
    read_device(instruction, exit);
    host_.jump(done);
  });
  return {Value::Kind::kByte};
}

// A table within the window is read without a check of the address.
Value BlockEmitter::read_indexed(const Instruction& instruction, Reg index) {
  const std::uint16_t base = instruction.operand;
  if (is_cartridge(base) && as_.window.covers(base, 256)) {
    add_penalty(instruction, index);
    load_rom();
    return {Value::Kind::kTable, as_.window.offset_of(base), index};
  }
  if (!is_cartridge(base) && !is_cartridge(static_cast<std::uint16_t>(base + 0xFF)))
    return read_ram_or_device(instruction, index);
  host_.index_address(base, index);
  host_.wrap_address();
  add_penalty(instruction, index);
  host_.keep_bus(high_byte(base));
  read_at_address(instruction);
  return {Value::Kind::kByte};
}

// Reads RAM or a device.
Value BlockEmitter::read_ram_or_device(const Instruction& instruction, Reg index) {
  Label device, done;
  add_penalty(instruction, index);
  host_.offset_in_ram_at(instruction.operand, index, device);
  host_.read_ram();
  host_.bind(done);
  cold([this, instruction, index, exit = exit_state(), device, done]() mutable {
    host_.bind(device);
    host_.index_address(instruction.operand, index);
    host_.load_latch(high_byte(instruction.operand));
    read_device(instruction, exit);
    host_.jump(done);
  });
  return {Value::Kind::kByte};
}

Value BlockEmitter::read_through_pointer(const Instruction& instruction) {
  if (!load_pointer(instruction)) return {Value::Kind::kConstant};
  host_.keep_bus_of_pointer();
  if (instruction.mode == Mode::indirect_y) host_.add_y_with_penalty();
  read_at_address(instruction);
  return {Value::Kind::kByte};
}

// Emits a load of the pointer of (zp),Y or (zp,X) into `address`. Returns false if it is not in RAM; the
// interpreter then executes the instruction.
bool BlockEmitter::load_pointer(const Instruction& instruction) {
  if (instruction.mode == Mode::indirect_y) {
    if (instruction.operand < 0x80 || instruction.operand == 0xFF) {
      settle(exit_state());
      exit_before(instruction);
      return false;
    }
    host_.load_pointer(instruction.operand);
    return true;
  }
  Label outside;
  host_.load_pointer_at_x(instruction.operand, outside);
  exit_out_of_line(outside, instruction, exit_state());
  return true;
}

// Reads the byte at `address`. Earlier code has kept the data bus, and has added the penalty for a crossed
// page. The common case is a table in the window's ROM.
void BlockEmitter::read_at_address(const Instruction& instruction) {
  Label elsewhere, done;
  load_rom();
  host_.read_window(elsewhere);
  host_.bind(done);
  cold([this, instruction, exit = exit_state(), elsewhere, done]() mutable {
    Label device, cartridge;
    host_.bind(elsewhere);
    host_.read_page(device);
    host_.jump(done);
    host_.bind(device);
    host_.jump_if_cartridge(cartridge);
    host_.latch_kept_bus();
    read_device(instruction, exit);
    host_.jump(done);
    host_.bind(cartridge);
    remove_penalty(instruction);
    settle(exit);
    exit_before(instruction);
  });
}

// Adds a cycle if the index crosses a page.
void BlockEmitter::add_penalty(const Instruction& instruction, Reg index) {
  const int low = instruction.operand & 0xFF;
  if (low != 0) host_.add_cycle_if(index, 256 - low);
}

void BlockEmitter::remove_penalty(const Instruction& instruction) {
  const int low = instruction.operand & 0xFF;
  if (instruction.mode == Mode::indirect_y) return host_.remove_cycle_of_pointer(instruction.operand);
  const bool is_indexed = instruction.mode == Mode::absolute_x || instruction.mode == Mode::absolute_y;
  if (is_indexed && low != 0)
    host_.remove_cycle_if(instruction.mode == Mode::absolute_x ? Reg::kX : Reg::kY, 256 - low);
}

void BlockEmitter::load_rom() {
  if (!rom_loaded_) host_.load_rom();
  rom_loaded_ = true;
}

// Loads the ROM's address again, since a call may have overwritten its register.
void BlockEmitter::load_rom_again(const ExitState& exit) {
  if (exit.rom_loaded) host_.load_rom();
}

}  // namespace racebeam::translator

#include "emulator/translator/liveness.hpp"

#include "emulator/translator/addresses.hpp"

namespace racebeam::translator {
namespace {

bool sets_carry(Operation operation) {
  switch (operation) {
    case Operation::adc:
    case Operation::sbc:
    case Operation::cmp:
    case Operation::cpx:
    case Operation::cpy:
    case Operation::asl:
    case Operation::lsr:
    case Operation::rol:
    case Operation::ror:
    case Operation::clc:
    case Operation::sec: return true;
    default: return false;
  }
}

bool sets_overflow(Operation operation) {
  return operation == Operation::adc || operation == Operation::sbc || operation == Operation::bit ||
         operation == Operation::clv;
}

// All documented instructions set N and Z except these.
bool sets_nz(const Instruction& instruction) {
  switch (instruction.operation) {
    case Operation::clc:
    case Operation::cld:
    case Operation::cli:
    case Operation::clv:
    case Operation::sec:
    case Operation::sed:
    case Operation::sei:
    case Operation::nop:
    case Operation::pha:
    case Operation::php:
    case Operation::txs: return false;
    default:
      return instruction.access != Access::Write && instruction.access != Access::Branch &&
             instruction.access != Access::Jump;
  }
}

bool reads_carry(Operation operation) {
  return operation == Operation::adc || operation == Operation::sbc || operation == Operation::rol ||
         operation == Operation::ror;
}

// Whether a read may access a hot spot. It may unless its address is known to be in the window, in RAM, or in
// a device that the cartridge ignores.
bool may_switch_banks(const Instruction& instruction, const Window& window) {
  if (instruction.access != Access::Read && instruction.access != Access::Modify) return false;
  if (window.cartridge_watches()) return true;
  const auto in_window = [&](unsigned count) {
    return is_cartridge(instruction.operand) &&
           ((instruction.operand - window.code.first) & 0x3FFFU) + count <= window.code.span;
  };
  // clang-format off
  switch (instruction.mode) {
    case Mode::absolute:
      return is_cartridge(instruction.operand) && !in_window(1) && window.port_reader(instruction.operand) == nullptr;
    case Mode::absolute_x: case Mode::absolute_y: return !in_window(256);
    case Mode::indirect_x: case Mode::indirect_y: return true;
    default: return false;
  }
  // clang-format on
}

}  // namespace

bool may_write_device(const Instruction& instruction) {
  // The stack may be in a device.
  if (instruction.operation == Operation::pha || instruction.operation == Operation::php) return true;
  if (instruction.access != Access::Write && instruction.access != Access::Modify) return false;
  const bool fixed = instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute;
  return !fixed || !is_ram(instruction.operand);
}

std::vector<Flags> live_flags(const Block& block, const Window& window) {
  std::vector<Flags> after(block.instructions.size());
  Flags live;
  for (std::size_t i = block.instructions.size(); i-- > 0;) {
    const Instruction& instruction = block.instructions[i];
    if (may_write_device(instruction)) live = Flags{};
    after[i] = live;
    if (may_switch_banks(instruction, window)) live = Flags{};
    if (sets_nz(instruction)) live.nz = false;
    if (sets_carry(instruction.operation)) live.c = false;
    if (sets_overflow(instruction.operation)) live.v = false;
    if (reads_carry(instruction.operation)) live.c = true;
    const bool sees_all = instruction.access == Access::Branch || instruction.access == Access::Jump ||
                          instruction.operation == Operation::php;
    if (sees_all) live = Flags{};
  }
  return after;
}

}  // namespace racebeam::translator

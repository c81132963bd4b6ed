#include "emulator/translator/instruction.hpp"

namespace racebeam::translator {

Instruction decode(const std::uint8_t* bytes, std::uint16_t pc) {
  const Opcode& row = kOpcodes[bytes[0]];
  const std::uint8_t length = row.operation == Operation::jsr ? 3 : row.length;
  const unsigned low = length > 1 ? bytes[1] : 0U, high = length > 2 ? bytes[2] : 0U;
  return {pc,
          row.operation,
          row.mode,
          row.access,
          length,
          row.cycles,
          static_cast<std::uint16_t>(low | high << 8)};
}

bool is_translatable(const Instruction& instruction) {
  // clang-format off
  switch (instruction.operation) {
    case Operation::brk: case Operation::plp: case Operation::rti: return false;
    case Operation::nop: return instruction.mode == Mode::implied;
    case Operation::sbc: return true;
    default: return instruction.operation < Operation::anc;
  }
  // clang-format on
}

}  // namespace racebeam::translator

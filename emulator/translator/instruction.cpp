#include "emulator/translator/instruction.hpp"

#include <array>

#include "emulator/base/opcodes.hpp"

namespace racebeam::translator {
namespace {

struct OpcodeRow {
  Operation operation;
  Mode mode;
  Access access;
  std::uint8_t cycles;
};

constexpr std::array<OpcodeRow, 256> kRows = {{
#define OP(code, operation, mode, access, cycles) {Operation::operation, Mode::mode, Access::access, cycles},
#include "emulator/base/opcodes.inc"
#undef OP
}};

}  // namespace

Instruction decode(const std::uint8_t* bytes, std::uint16_t pc) {
  const OpcodeRow& row = kRows[bytes[0]];
  const std::uint8_t length = row.operation == Operation::jsr ? 3 : kOpcodes[bytes[0]].length;
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

// Runs a cartridge that sees the accesses to operands. They follow from an instruction and from the registers
// before it. Only the last byte on the bus is known afterwards.
#include <array>
#include <cstddef>

#include "emulator/base/opcodes.hpp"
#include "emulator/cpu/cpu.hpp"

namespace racebeam {
namespace {

using opcode::Mode;
using Kind = opcode::Access;

// Plain memory; null if a device is there.
const std::uint8_t* byte_at(const Board& board, unsigned address) {
  const std::uint8_t* page = board.map.page_of(static_cast<std::uint16_t>(address));
  return page != nullptr ? page + address % MemoryMap::kPageSize : nullptr;
}

// The accesses of the instruction at PC, in their order.
class Operand {
 public:
  explicit Operand(const Board& board) : board_(board) {
    const CpuState& cpu = board.state.cpu;
    const std::uint8_t *code = byte_at(board, cpu.PC), *low = byte_at(board, cpu.PC + 1U),
                       *high = byte_at(board, cpu.PC + 2U);
    if (code != nullptr && low != nullptr && high != nullptr) find(kOpcodes[*code], *low, *high, cpu);
  }

  // Passes the accesses to the board. last: the byte on the data bus after the instruction.
  void show(Board& board, std::uint8_t last) {
    if (count_ != 0) all_[count_ - 1].value = last;
    for (std::size_t i = 0; i < count_; ++i) board.observe(all_[i]);
  }

 private:
  void add(unsigned address, std::uint8_t before, bool writes) {
    const std::uint8_t* byte = byte_at(board_, address);
    const auto value = static_cast<std::uint8_t>(byte != nullptr ? *byte : 0);
    all_[count_++] = {static_cast<std::uint16_t>(address), value, before, writes};
  }

  // Adds the accesses to the operand itself. An instruction that modifies it writes right after the read.
  void use(unsigned address, std::uint8_t before) {
    if (kind_ != Kind::Write) add(address, before, false);
    if (kind_ != Kind::Read) add(address, kind_ == Kind::Write ? before : std::uint8_t{0}, true);
  }

  void find(const Opcode& row, std::uint8_t low, std::uint8_t high, const CpuState& cpu) {
    const unsigned word = low | high * 256U;
    kind_ = row.access;
    switch (row.mode) {
      case Mode::zero_page: use(low, low); break;
      case Mode::zero_page_x: use((low + cpu.X) & 0xFFU, low); break;
      case Mode::zero_page_y: use((low + cpu.Y) & 0xFFU, low); break;
      case Mode::absolute:
        if (kind_ != Kind::Jump) use(word, high);
        break;
      case Mode::absolute_x: use(word + cpu.X, high); break;
      case Mode::absolute_y: use(word + cpu.Y, high); break;
      case Mode::indirect_x: follow((low + cpu.X) & 0xFFU, low, 0); break;
      case Mode::indirect_y: follow(low, low, cpu.Y); break;
      default: break;
    }
  }

  // Adds the accesses to a pointer, and to the operand that it points to. Pointers in the TIA are not
  // followed.
  void follow(unsigned place, std::uint8_t before, unsigned index) {
    const std::uint8_t *low = byte_at(board_, place), *high = byte_at(board_, place + 1);
    if (low != nullptr) add(place, before, false);
    if (low == nullptr || high == nullptr) return;
    add(place + 1, *low, false);
    use(*low + *high * 256U + index, *high);
  }

  const Board& board_;
  std::array<Access, 4> all_{};
  std::size_t count_ = 0;
  Kind kind_ = Kind::Implied;
};

}  // namespace

void interpret_observed(Board& board, std::int32_t instructions) {
  board.stop = false;
  for (std::int32_t i = 0; i < instructions && !board.stop && !board.state.cpu.jammed; ++i) {
    Operand operand(board);
    interpret(board, 1, 1);
    operand.show(board, board.state.cpu.latch);
  }
}

}  // namespace racebeam

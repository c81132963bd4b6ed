#include "emulator/translator/program.hpp"

#include "emulator/registers.hpp"
#include "emulator/translator/addresses.hpp"

namespace racebeam::translator {
namespace {

bool ends_flow(const Instruction& instruction) { return instruction.access == Access::Jump; }

// Its address is the operand.
bool is_fixed(const Instruction& instruction) {
  return instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute;
}

bool leads_to_operand(const Instruction& instruction) {
  return instruction.operation == Operation::jsr ||
         (instruction.operation == Operation::jmp && instruction.mode == Mode::absolute);
}

// After it the line is another one: the limit of the frame is looked at anew.
bool is_wsync(const Instruction& instruction) {
  return instruction.access == Access::Write && is_fixed(instruction) &&
         (instruction.operand & 0x10BF) == WSYNC;
}

// Both bytes can be read as one word of RAM.
bool is_word_of_ram(std::uint16_t address) { return is_ram(address) && (address & 0x7F) != 0x7F; }

class Discovery {
 public:
  Discovery(const Window& window, const std::vector<bool>& known)
      : wiring_(window),
        window_(window.code),
        known_(known),
        role_(window_.span, kNone),
        seen_(window_.span) {}

  std::vector<Block> run(std::uint16_t entry) {
    lead(entry, kLeader);
    while (!pending_.empty()) {
      const std::uint16_t pc = pending_.back();
      pending_.pop_back();
      scan(pc);
    }
    std::vector<Block> blocks;
    for (std::size_t offset = 0; offset < role_.size(); ++offset)
      if (role_[offset] != kNone) blocks.push_back(block_at(offset));
    return blocks;
  }

 private:
  enum Role : std::uint8_t { kNone, kLeader, kLoop };

  std::size_t offset(std::uint16_t pc) const { return static_cast<std::uint16_t>(pc - window_.first); }
  Instruction at(std::uint16_t pc) const { return decode(window_.memory + offset(pc), pc); }

  void lead(std::uint16_t pc, Role role) {
    if (!holds(window_, pc) || known_[offset(pc)]) return;
    Role& known = role_[offset(pc)];
    if (known == kNone) pending_.push_back(pc);
    if (role > known) known = role;
  }

  // What lies beyond the window may be a device, and reads what was on the data bus: the interpreter knows
  // that.
  bool leads_out(const Instruction& instruction) const {
    const bool branches = instruction.access == Access::Branch && !holds(window_, instruction.target());
    return branches || (!ends_flow(instruction) && !holds(window_, instruction.next()));
  }

  // Follows the instructions from `pc` on, and makes leaders of all that they lead to.
  void scan(std::uint16_t pc) {
    while (holds(window_, pc) && !seen_[offset(pc)]) {
      seen_[offset(pc)] = true;
      const Instruction instruction = at(pc);
      if (instruction.access == Access::Branch || leads_to_operand(instruction))
        lead(instruction.target(), instruction.target() <= pc ? kLoop : kLeader);
      const bool interpreted = is_interpreted(instruction, wiring_);
      if (instruction.operation == Operation::jsr || is_wsync(instruction) ||
          (interpreted && !ends_flow(instruction)))
        lead(instruction.next(), kLeader);
      if (ends_flow(instruction) || interpreted) return;
      pc = instruction.next();
    }
  }

  // Up to the next leader, a jump, what the interpreter must do, or the most cycles; then a new leader goes
  // on.
  Block block_at(std::size_t start) {
    Block block;
    block.pc = block.next = static_cast<std::uint16_t>(window_.first + start);
    block.loops = role_[start] == kLoop;
    for (int cycles = 0; holds(window_, block.next);) {
      const std::size_t here = offset(block.next);
      if (here != start && (role_[here] != kNone || known_[here])) break;
      const Instruction instruction = at(block.next);
      if (is_interpreted(instruction, wiring_) || leads_out(instruction)) break;
      cycles += instruction.cycles + 2;
      if (cycles > kMostBlockCycles) {
        role_[here] = kLeader;  // it lies further on: its turn comes
        break;
      }
      block.instructions.push_back(instruction);
      block.next = instruction.next();
      if (ends_flow(instruction)) break;
    }
    return block;
  }

  const Window& wiring_;
  const CodeWindow& window_;
  const std::vector<bool>& known_;
  std::vector<Role> role_;
  std::vector<bool> seen_;
  std::vector<std::uint16_t> pending_;
};

}  // namespace

bool is_interpreted(const Instruction& instruction, const Window& window) {
  if (!is_translatable(instruction)) return true;
  const std::uint16_t operand = instruction.operand;
  const auto is_watched = [&](std::uint16_t address) {
    return window.cartridge_watches() && !is_ram(address) && !is_cartridge(address);
  };
  if (instruction.mode == Mode::indirect || instruction.mode == Mode::indirect_y)
    return !is_word_of_ram(operand);
  switch (instruction.access) {
    case Access::Jump: return leads_to_operand(instruction) && !is_cartridge(operand);
    case Access::Modify: return is_fixed(instruction) && (is_cartridge(operand) || is_watched(operand));
    case Access::Read: return is_fixed(instruction) && is_watched(operand);
    default: return false;
  }
}

std::vector<Block> discover(const Window& window, std::uint16_t entry, const std::vector<bool>& known) {
  return Discovery(window, known).run(entry);
}

}  // namespace racebeam::translator

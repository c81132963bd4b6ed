#include "emulator/translator/program.hpp"

#include "emulator/tia/registers/registers.hpp"

namespace racebeam::translator {
namespace {

bool ends_flow(const Instruction& instruction) { return instruction.access == Access::Jump; }

// After it the line is another one: the limit of the frame is looked at anew.
bool is_wsync(const Instruction& instruction) {
  const bool fixed = instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute;
  return instruction.access == Access::Write && fixed && (instruction.operand & 0x10BF) == WSYNC;
}

class Discovery {
 public:
  Discovery(const CodeWindow& window, const std::vector<bool>& known)
      : window_(window), known_(known), role_(window.span, kNone), seen_(window.span) {}

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

  // What lies beyond the window may be a device, and reads what was on the data bus: the interpreter knows that.
  bool leads_out(const Instruction& instruction) const {
    const bool branches = instruction.access == Access::Branch && !holds(window_, instruction.target());
    return branches || (!ends_flow(instruction) && !holds(window_, instruction.next()));
  }

  // Follows the instructions from `pc` on, and makes leaders of all that they lead to.
  void scan(std::uint16_t pc) {
    while (holds(window_, pc) && !seen_[offset(pc)]) {
      seen_[offset(pc)] = true;
      const Instruction instruction = at(pc);
      if (instruction.access == Access::Branch || instruction.operation == Operation::jsr ||
          (instruction.operation == Operation::jmp && instruction.mode == Mode::absolute))
        lead(instruction.target(), instruction.target() <= pc ? kLoop : kLeader);
      if (instruction.operation == Operation::jsr || is_wsync(instruction) || !is_translatable(instruction))
        lead(instruction.next(), kLeader);
      if (ends_flow(instruction) || !is_translatable(instruction)) return;
      pc = instruction.next();
    }
  }

  // Up to the next leader, a jump, what the interpreter must do, or the most cycles; then a new leader goes on.
  Block block_at(std::size_t start) {
    Block block;
    block.pc = block.next = static_cast<std::uint16_t>(window_.first + start);
    block.loops = role_[start] == kLoop;
    for (int cycles = 0; holds(window_, block.next);) {
      const std::size_t here = offset(block.next);
      if (here != start && (role_[here] != kNone || known_[here])) break;
      const Instruction instruction = at(block.next);
      if (!is_translatable(instruction) || leads_out(instruction)) break;
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

  const CodeWindow window_;
  const std::vector<bool>& known_;
  std::vector<Role> role_;
  std::vector<bool> seen_;
  std::vector<std::uint16_t> pending_;
};

}  // namespace

std::vector<Block> discover(const CodeWindow& window, std::uint16_t entry, const std::vector<bool>& known) {
  return Discovery(window, known).run(entry);
}

}  // namespace racebeam::translator

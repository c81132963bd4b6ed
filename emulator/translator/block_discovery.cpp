#include "emulator/translator/block_discovery.hpp"

#include <algorithm>
#include <map>

#include "emulator/policies/tuning.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam::translator {
namespace {

bool ends_flow(const Instruction& instruction) { return instruction.access == Access::Jump; }

// Whether the instruction waits for a new line. The block after it checks the line limit again.
bool is_wsync(const Instruction& instruction) {
  const bool fixed = instruction.mode == Mode::zero_page || instruction.mode == Mode::absolute;
  return instruction.access == Access::Write && fixed && (instruction.operand & 0x10BF) == WSYNC;
}

class Discovery {
 public:
  Discovery(const CodeWindow& window, const std::vector<bool>& starts)
      : window_(window), known_(starts), seen_(window.span) {}

  std::vector<Block> run(std::uint16_t entry) {
    add_leader(entry, kLeader);
    for (std::size_t next = 0; next < pending_.size(); ++next) scan(pending_[next]);
    std::erase_if(leaders_, [this](const auto& leader) { return !seen_[leader.first]; });
    std::vector<Block> blocks;
    for (auto leader = leaders_.begin(); leader != leaders_.end(); ++leader)
      blocks.push_back(block_at(*leader));
    return blocks;
  }

 private:
  enum Role : std::uint8_t { kLeader, kLoop };
  using Leaders = std::map<std::size_t, Role>;  // first instructions of blocks, by offset in the window

  std::size_t offset(std::uint16_t pc) const { return static_cast<std::uint16_t>(pc - window_.first); }
  Instruction at(std::uint16_t pc) const { return decode(window_.memory + offset(pc), pc); }

  void add_leader(std::uint16_t pc, Role role) {
    if (!contains(window_, pc) || known_[offset(pc)]) return;
    const auto [leader, is_new] = leaders_.emplace(offset(pc), role);
    if (is_new) pending_.push_back(pc), work_ += tuning::kWorkOfBlock;
    leader->second = std::max(leader->second, role);
  }

  // Whether execution may continue outside the window after the instruction. There may be a device, whose
  // value depends on the data bus; the interpreter handles that.
  bool leads_out(const Instruction& instruction) const {
    const bool branches = instruction.access == Access::Branch && !contains(window_, instruction.target());
    return branches || (!ends_flow(instruction) && !contains(window_, instruction.next()));
  }

  // Follows the instructions from `pc`. The addresses of blocks that they lead to become leaders.
  void scan(std::uint16_t pc) {
    while (contains(window_, pc) && !seen_[offset(pc)] && work_ < tuning::kMaxWork) {
      seen_[offset(pc)] = true;
      ++work_;
      const Instruction instruction = at(pc);
      if (instruction.access == Access::Branch || instruction.operation == Operation::jsr ||
          (instruction.operation == Operation::jmp && instruction.mode == Mode::absolute))
        add_leader(instruction.target(), instruction.target() <= pc ? kLoop : kLeader);
      if (instruction.operation == Operation::jsr || is_wsync(instruction) || !is_translatable(instruction))
        add_leader(instruction.next(), kLeader);
      if (ends_flow(instruction) || !is_translatable(instruction)) return;
      pc = instruction.next();
    }
  }

  // A block from `leader` to the next leader, a jump, an instruction for the interpreter, or
  // kMaxBlockCycles. In the last case a new leader continues it.
  Block block_at(const Leaders::value_type& leader) {
    const auto [start, role] = leader;
    Block block;
    block.pc = block.next = static_cast<std::uint16_t>(window_.first + start);
    block.is_loop_head = role == kLoop;
    for (int cycles = 0; contains(window_, block.next);) {
      const std::size_t here = offset(block.next);
      if (here != start && (leaders_.contains(here) || known_[here] || !seen_[here])) break;
      const Instruction instruction = at(block.next);
      if (!is_translatable(instruction) || leads_out(instruction)) break;
      cycles += instruction.cycles + 2;
      if (cycles > tuning::kMaxBlockCycles) {
        leaders_.emplace(here, kLeader);  // at a higher address, so the loop over the leaders reaches it
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
  Leaders leaders_;
  std::vector<bool> seen_;
  std::vector<std::uint16_t> pending_;
  int work_ = 0;
};

}  // namespace

std::vector<Block> discover(const CodeWindow& window, std::uint16_t entry, const std::vector<bool>& known) {
  return Discovery(window, known).run(entry);
}

}  // namespace racebeam::translator

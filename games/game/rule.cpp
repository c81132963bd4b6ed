#include "games/game/rule.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

#include "games/game/game.hpp"

namespace racebeam {

static_assert(std::has_unique_object_representations_v<RuleState>);  // so that it can be compared with memcmp

Rule::Rule(const Game& game) : program_(game.rule ? &*game.rule : nullptr) { reset(); }

void Rule::reset() {
  if (!program_) return;
  is_settled_ = false;
  std::int32_t* value = state_.values.data();
  for (const Variable& variable : program_->variables) {
    if (!variable.kept) *value = variable.initial;
    ++value;
  }
}

void Rule::step(const Memory& memory) {
  if (!program_ || would_change_nothing(memory.ram)) return;
  const RuleState before = state_;
  execute(program_->step, state_.values.data(), memory);
  is_settled_ = program_->inputs && state_ == before;
  if (is_settled_) std::ranges::copy_n(memory.ram, kRamBytes, settled_ram_.begin());
}

// Most frames change no byte that the rule reads.
bool Rule::would_change_nothing(const std::uint8_t* ram) const {
  if (!is_settled_) return false;
  unsigned changed = 0;
  for (std::size_t i = 0; i < kRamBytes; ++i)
    changed |= static_cast<unsigned>((ram[i] ^ settled_ram_[i]) & (*program_->inputs)[i]);
  return changed == 0;
}

int Rule::reward() const { return state_.values[kRewardSlot]; }

int Rule::reward_b() const {
  if (!program_ || !program_->reward_b) return 0;
  return state_.values[static_cast<std::size_t>(*program_->reward_b)];
}

bool Rule::terminal() const {
  return program_ && evaluate(program_->terminal, state_.values.data(), {}) != 0;
}

int Rule::lives() const { return program_ ? evaluate(program_->lives, state_.values.data(), {}) : 0; }

std::optional<int> Rule::last_byte() const {
  if (!program_) return std::nullopt;
  const auto reads_memory = [](const Instruction& instruction) {
    return instruction.op == Op::kRam || instruction.op == Op::kRamAt || instruction.op == Op::kMemAt;
  };
  const std::vector<Instruction>& code = program_->step.code;
  const auto last = std::find_if(code.rbegin(), code.rend(), reads_memory);
  return last != code.rend() && last->op == Op::kRam ? std::optional(last->value) : std::nullopt;
}

bool Rule::keeps_variables() const {
  return program_ && std::ranges::any_of(program_->variables, &Variable::kept);
}

int Rule::initial_lives() const {
  Rule fresh = *this;
  fresh.restore({});
  fresh.reset();
  return fresh.lives();
}

}  // namespace racebeam

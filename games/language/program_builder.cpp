#include "games/language/program_builder.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

namespace racebeam {
namespace {

// How many of a, b, c an instruction uses.
std::size_t operand_count(Op op) {
  if (op < Op::kRamAt) return 0;
  if (op < Op::kAdd) return 1;
  return op < Op::kSelect ? 2 : 3;
}

// The operands that the instruction uses.
std::vector<Register*> operands(Instruction& instruction) {
  std::vector<Register*> list = {&instruction.a, &instruction.b, &instruction.c};
  list.resize(operand_count(instruction.op));
  return list;
}

bool is_load(Op op) { return op <= Op::kMemAt; }

}  // namespace

Register ProgramBuilder::emit(const Instruction& instruction) {
  if (can_fold(instruction)) {
    const auto value = [this](Register from) { return program_.code[from].value; };
    return constant(apply(instruction.op, value(instruction.a), value(instruction.b), value(instruction.c)));
  }
  const auto next = static_cast<Register>(program_.code.size());
  const auto [place, is_new] = known_.try_emplace(instruction, next);
  if (!is_new) return place->second;
  if (program_.code.size() == kMaxInstructions)
    throw std::length_error("the rule is too long: it needs more than " + std::to_string(kMaxInstructions) +
                            " instructions");
  program_.code.push_back(instruction);
  return next;
}

bool ProgramBuilder::can_fold(Instruction instruction) const {
  for (const Register* operand : operands(instruction))
    if (!constant_value(*operand)) return false;
  return !is_load(instruction.op);
}

std::optional<std::int32_t> ProgramBuilder::constant_value(Register from) const {
  const Instruction& instruction = program_.code[from];
  return instruction.op == Op::kConstant ? std::optional(instruction.value) : std::nullopt;
}

Program ProgramBuilder::finish(Register result) {
  program_.result = result;
  known_.clear();
  drop_unused();
  return std::exchange(program_, {});
}

// Removes constants that were folded away, addresses above all.
void ProgramBuilder::drop_unused() {
  const std::vector<bool> used = used_code();
  std::vector<Register> moved(used.size());
  std::vector<Instruction> instructions;
  for (std::size_t i = 0; i < used.size(); ++i) {
    moved[i] = static_cast<Register>(instructions.size());
    if (used[i]) instructions.push_back(program_.code[i]);
  }
  for (Instruction& instruction : instructions)
    for (Register* operand : operands(instruction)) *operand = moved[*operand];
  for (Output& output : program_.outputs) output.from = moved[output.from];
  program_.result = moved[program_.result];
  program_.code = std::move(instructions);
}

// Operands have lower numbers than the instructions that use them.
std::vector<bool> ProgramBuilder::used_code() const {
  std::vector<bool> used(program_.code.size());
  for (const Output& output : program_.outputs) used[output.from] = true;
  if (program_.outputs.empty()) used[program_.result] = true;
  mark_operands(used);
  return used;
}

void ProgramBuilder::mark_operands(std::vector<bool>& used) const {
  for (std::size_t i = used.size(); i-- > 0;) {
    if (!used[i]) continue;
    Instruction instruction = program_.code[i];
    for (const Register* operand : operands(instruction)) used[*operand] = true;
  }
}

std::set<int> ProgramBuilder::ram_bytes(Register from) const {
  std::vector<bool> used(program_.code.size());
  used[from] = true;
  mark_operands(used);
  std::set<int> bytes;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && program_.code[i].op == Op::kRam) bytes.insert(program_.code[i].value);
  return bytes;
}

}  // namespace racebeam

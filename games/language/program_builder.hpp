// Builds a program: folds constants, and never computes the same value twice.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "games/game/program.hpp"

namespace racebeam {

class ProgramBuilder {
 public:
  Register constant(std::int32_t value) { return emit({.op = Op::kConstant, .value = value}); }
  Register variable(int slot) { return emit({.op = Op::kVariable, .value = slot}); }
  Register emit(const Instruction& instruction);  // throws std::length_error if the program gets too long

  std::optional<std::int32_t> constant_value(Register from) const;
  // The bytes of RAM, at fixed places, that this value depends on.
  std::set<int> ram_bytes(Register from) const;
  void output(int slot, Register from) { program_.outputs.push_back({slot, from}); }
  Program finish(Register result = 0);

 private:
  bool can_fold(Instruction instruction) const;
  void drop_unused();
  std::vector<bool> used_code() const;
  void mark_operands(std::vector<bool>& used) const;  // of code that is marked

  Program program_;
  std::map<Instruction, Register> known_;
};

}  // namespace racebeam

// Compiles the texts of a game file's rule and mode program. Call in this order: wraps, reset_to and keep,
// step, terminal, lives, mode_program, finish. Throws SourceError, with the line in the text, and
// InvalidInput.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "games/game/mode_program.hpp"
#include "games/game/rule.hpp"
#include "games/language/expression.hpp"

namespace racebeam {

class RuleCompiler {
 public:
  // Scores start again at 0 when they reach `modulus`. Rewards that follow from a score take that into
  // account.
  void wraps(std::int32_t modulus) { modulus_ = modulus; }

  void reset_to(std::string_view variable, std::int32_t initial) { names_.reset_to(variable, initial); }
  void keep(std::string_view variable) { names_.keep(variable); }

  void step(std::string_view source);
  void terminal(std::string_view source) { rule_.terminal = answer(source); }
  void lives(std::string_view source) { rule_.lives = answer(source); }
  ModeProgram mode_program(std::string_view source);

  bool assigns(std::string_view variable) const {
    return step_scope_.values.find(variable) != step_scope_.values.end();
  }
  bool uses(std::string_view variable) const { return names_.slot_if_used(variable).has_value(); }
  RuleProgram finish();

 private:
  void declare_assigned(TokenReader reader);
  void assignment(TokenReader& reader);
  void imply_reward(const char* reward, const char* score);
  Program answer(std::string_view source);

  VariableNames names_;
  Scope step_scope_{Purpose::kStep, names_};
  ProgramBuilder step_;
  std::map<int, std::string> bytes_;  // of RAM, by their index: the first variable that reads them
  RuleProgram rule_;
  std::optional<std::int32_t> modulus_;
};

}  // namespace racebeam

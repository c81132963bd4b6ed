#include "games/language/rule_compiler.hpp"

#include <vector>

#include "games/language/lexer.hpp"
#include "games/language/mode_compiler.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

bool starts_assignment(const TokenReader& reader) {
  return reader.peek().kind == Token::Kind::kName && reader.is("=", 1);
}

void declare(VariableNames& names, const Token& name) {
  try {
    names.declare(name.text);
  } catch (const InvalidInput& error) {
    throw SourceError(name.line, error.what());
  }
}

}  // namespace

void RuleCompiler::step(std::string_view source) {
  const std::vector<Token> tokens = tokens_of(source);
  declare_assigned(TokenReader(tokens));
  TokenReader reader(tokens);
  for (reader.skip_separators(); !reader.at_end(); reader.skip_separators()) assignment(reader);
  if (!assigns("terminal"))
    reader.refuse("nothing assigns 'terminal'; write terminal = 0 if the game never ends");
  if (!assigns("reward") && !assigns("score")) reader.refuse("nothing assigns 'score' or 'reward'");
  if (!assigns("reward")) imply_reward("reward", "score");
  if (!assigns("reward_b") && assigns("score_b")) imply_reward("reward_b", "score_b");
}

// All names that the step assigns may be read anywhere in it. Before their assignment, they have the value of
// the previous frame.
void RuleCompiler::declare_assigned(TokenReader reader) {
  for (; !reader.at_end(); reader.next())
    if (starts_assignment(reader)) declare(names_, reader.peek());
}

void RuleCompiler::assignment(TokenReader& reader) {
  if (!starts_assignment(reader))
    reader.refuse("expected NAME = EXPRESSION, found " + described(reader.peek()));
  const std::string name(reader.next().text);
  reader.next();
  const Register value = compile_expression(reader, step_scope_, step_);
  reader.expect_separator();
  step_scope_.values[name] = value;
  for (const int byte : step_.ram_bytes(value)) bytes_.try_emplace(byte, name);
}

void RuleCompiler::imply_reward(const char* reward, const char* score) {
  const Register before = step_.variable(names_.slot(score));
  const Register change = step_.emit({.op = Op::kSubtract, .a = step_scope_.values[score], .b = before});
  names_.declare(reward);
  step_scope_.values[reward] = modulus_ ? emit_wrapped(step_, change, *modulus_) : change;
}

Program RuleCompiler::answer(std::string_view source) {
  const std::vector<Token> tokens = tokens_of(source);
  TokenReader reader(tokens);
  Scope scope{Purpose::kAnswer, names_};
  ProgramBuilder builder;
  const Register value = compile_expression(reader, scope, builder);
  reader.skip_separators();
  if (!reader.at_end())
    reader.refuse("expected the end of the expression, found " + described(reader.peek()));
  return builder.finish(value);
}

ModeProgram RuleCompiler::mode_program(std::string_view source) {
  return compile_mode_program(source, names_);
}

RuleProgram RuleCompiler::finish() {
  if (assigns("reward_b")) rule_.reward_b = names_.slot("reward_b");
  rule_.variables = names_.variables();
  for (const auto& [index, name] : bytes_) rule_.bytes.push_back({index, name});
  for (const auto& [name, value] : step_scope_.values)
    if (const std::optional<int> slot = names_.slot_if_used(name)) step_.output(*slot, value);
  rule_.step = step_.finish();
  rule_.inputs = ram_read_by(rule_.step);
  return std::move(rule_);
}

}  // namespace racebeam

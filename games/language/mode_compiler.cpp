#include "games/language/mode_compiler.hpp"

#include <utility>

#include "games/game/actions.hpp"
#include "games/language/expression.hpp"
#include "games/language/lexer.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kDeepestBlock = 50;

class StatementCompiler {
 public:
  StatementCompiler(const std::vector<Token>& tokens, VariableNames& names)
      : in_(tokens), scope_{Purpose::kMode, names} {
    scope_.locals.emplace("mode", kModeSlot);
  }

  std::vector<Statement> program() {
    std::vector<Statement> list = statements();
    if (!in_.at_end()) in_.refuse("'}' without '{'");
    return list;
  }

 private:
  using Kind = Statement::Kind;

  std::vector<Statement> statements() {
    std::vector<Statement> list;
    for (in_.skip_separators(); !in_.at_end() && !in_.is("}"); in_.skip_separators()) {
      list.push_back(statement());
      in_.expect_separator();
    }
    return list;
  }

  Statement statement() {
    if (in_.is("=", 1)) return assignment();
    if (in_.accept("select")) return with_expression(Kind::kSelect);
    if (in_.accept("act")) return act();
    if (in_.accept("soft_reset")) return {.kind = Kind::kSoftReset};
    if (in_.accept("while")) return loop();
    if (in_.accept("if")) return branch();
    if (in_.accept("fail")) return fail();
    in_.refuse("expected a statement (NAME = ..., select, act, soft_reset, while, if or fail), found " +
               described(in_.peek()));
  }

  Statement with_expression(Kind kind) {
    Statement statement{.kind = kind};
    ProgramBuilder builder;
    scope_.draws = false;
    const Register value = compile_expression(in_, scope_, builder);
    statement.expression = builder.finish(value);
    statement.draws = scope_.draws;
    return statement;
  }

  Statement assignment() {
    const Token name = in_.next();
    in_.next();
    Statement statement = with_expression(Kind::kAssign);
    statement.target = target(name);
    return statement;
  }

  int target(const Token& name) {
    try {
      if (scope_.names.knows(name.text)) return scope_.names.slot(name.text);
      VariableNames().declare(name.text);  // refuses an invalid name
    } catch (const InvalidInput& error) {
      throw SourceError(name.line, error.what());
    }
    const auto found = scope_.locals.find(name.text);
    if (found != scope_.locals.end()) return found->second;
    const int slot = kFirstLocalSlot + static_cast<int>(scope_.locals.size()) - 1;  // 'mode' is one of them
    if (slot == kMaxModeVariables) throw SourceError(name.line, "the mode program has too many variables");
    scope_.locals.emplace(name.text, slot);
    return slot;
  }

  Statement act() {
    const Token name = in_.next();
    const std::optional<int> action = action_number(name.text);
    if (!action || *action >= kActions) throw SourceError(name.line, described(name) + " is not an action");
    const bool has_count = in_.peek().kind != Token::Kind::kLineEnd && !in_.is(";") && !in_.is("}");
    Statement statement =
        has_count ? with_expression(Kind::kAct) : Statement{.kind = Kind::kAct, .expression = one()};
    statement.target = *action;
    return statement;
  }

  static Program one() {
    ProgramBuilder builder;
    return builder.finish(builder.constant(1));
  }

  Statement loop() {
    Statement statement = with_expression(Kind::kWhile);
    statement.body = block();
    return statement;
  }

  Statement branch() {
    Statement statement = with_expression(Kind::kIf);
    statement.body = block();
    if (in_.accept("else")) statement.otherwise = block();
    return statement;
  }

  std::vector<Statement> block() {
    if (++depth_ > kDeepestBlock) in_.refuse("the blocks are nested too deeply");
    in_.expect("{", "before the statements");
    std::vector<Statement> list = statements();
    in_.expect("}", "after the statements");
    --depth_;
    return list;
  }

  Statement fail() {
    if (in_.peek().kind != Token::Kind::kText)
      in_.refuse("expected a \"text\" after fail, found " + described(in_.peek()));
    return {.kind = Kind::kFail, .text = std::string(in_.next().text)};
  }

  TokenReader in_;
  Scope scope_;
  int depth_ = 0;
};

}  // namespace

ModeProgram compile_mode_program(std::string_view source, VariableNames& names) {
  const std::vector<Token> tokens = tokens_of(source);
  return {StatementCompiler(tokens, names).program()};
}

}  // namespace racebeam

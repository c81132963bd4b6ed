// Compiles the expressions of the rule language (games/catalogue/README.md, "Expressions").
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "games/language/lexer.hpp"
#include "games/language/program_builder.hpp"
#include "games/language/variable_names.hpp"

namespace racebeam {

enum class Purpose {
  kStep,    // what happens after a frame: memory, variables, and prev()
  kAnswer,  // a question between frames: variables only
  kMode,    // in a mode program: memory, variables, mode and rng()
};

// What names mean at one place of a rule.
struct Scope {
  Purpose purpose;
  VariableNames& names;
  std::map<std::string, int, std::less<>> locals{};       // slots of a mode program's own variables
  std::map<std::string, Register, std::less<>> values{};  // what was assigned so far, and what sum() binds
  bool draws = false;                                     // rng() was met
};

constexpr std::int32_t kLeastModulus = 10;

// The change of a counter that starts again at 0 when it reaches `modulus`, at least kLeastModulus: a fall by
// nine tenths of it or more is taken for a gain across the wrap, and so is a rise for a loss. Lesser falls
// stay falls, since games also clear their scores.
Register emit_wrapped(ProgramBuilder& out, Register change, std::int32_t modulus);

// Reads one expression and returns where its value will be. Throws SourceError.
Register compile_expression(TokenReader& reader, Scope& scope, ProgramBuilder& builder);

}  // namespace racebeam

// Compiles the expressions of the rule language (games/catalogue/README.md, "Expressions").
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "games/lexer.hpp"
#include "games/names.hpp"
#include "games/program_builder.hpp"

namespace racebeam {

enum class Purpose {
  kStep,    // what happens after a frame: memory, variables, and prev()
  kAnswer,  // a question between frames: variables only
  kMode,    // in a mode program: memory, variables, mode and rng()
};

// What names mean at one place of a rule.
struct Scope {
  Purpose purpose;
  Names& names;
  std::map<std::string, int, std::less<>> locals{};       // slots of a mode program's own variables
  std::map<std::string, Register, std::less<>> values{};  // what was assigned so far, and what sum() binds
  bool draws = false;                                     // rng() was met
};

// Reads one expression and returns where its value will be. Throws SourceError.
Register compile_expression(TokenReader& reader, Scope& scope, ProgramBuilder& builder);

}  // namespace racebeam

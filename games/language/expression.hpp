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
  kStep,    // for what happens after a frame: memory, variables, and prev()
  kAnswer,  // for a query between frames: variables only
  kMode,    // for a mode program: memory, variables, mode and rng()
};

// The meaning of names at one point of a rule.
struct Scope {
  Purpose purpose;
  VariableNames& names;
  std::map<std::string, int, std::less<>> locals{};       // slots of a mode program's own variables
  std::map<std::string, Register, std::less<>> values{};  // assigned so far, or bound by sum()
  bool draws = false;                                     // rng() occurred
};

constexpr std::int32_t kMinModulus = 10;

// The change of a counter that starts again at 0 when it reaches `modulus`, which is at least kMinModulus.
// A drop by nine tenths of `modulus` or more is treated as a gain across the wrap, and such a rise as a
// loss. Smaller drops are not corrected, because games also clear their scores.
Register emit_wrapped(ProgramBuilder& out, Register change, std::int32_t modulus);

// Reads one expression and returns the register of its value. Throws SourceError.
Register compile_expression(TokenReader& reader, Scope& scope, ProgramBuilder& builder);

}  // namespace racebeam

// Compiled expressions: straight-line code in which instruction n produces value n. Without loops, it always
// terminates. Executing it allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "games/game/memory.hpp"

namespace racebeam {

constexpr int kMaxVariables = 16;       // of a rule: what persists from frame to frame
constexpr int kMaxInstructions = 2048;  // of one program

enum class Op : std::uint8_t {
  kConstant,  // `value`
  kVariable,  // variable number `value`
  kRam,       // byte number `value` of RAM
  kRamAt,     // byte of RAM at address a
  kMemAt,     // byte on the bus at address a
  kBcd,
  kSigned8,
  kUnsigned8,
  kNegate,
  kNot,
  kComplement,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kRemainder,
  kShiftLeft,
  kShiftRight,
  kBitAnd,
  kBitXor,
  kBitOr,
  kEqual,
  kNotEqual,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kAnd,
  kOr,
  kMin,
  kMax,
  kSelect,  // a ? b : c
};

using Register = std::uint16_t;  // the number of the instruction that produces the value

struct Instruction {
  Op op = Op::kConstant;
  Register a = 0, b = 0, c = 0;
  std::int32_t value = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): a fault of clang-tidy 14
  auto operator<=>(const Instruction&) const = default;
};

struct Output {
  int variable = 0;
  Register from = 0;
};

struct Program {
  std::vector<Instruction> code;
  // Copied into the variables at the end, so that all code sees their old values.
  std::vector<Output> outputs;
  Register result = 0;  // of an expression
};

// The bytes of RAM that the program may read. Nothing if it may read other memory, too.
std::optional<RamMask> ram_read_by(const Program& program);

// Applies an operator, any but those that load, in 32-bit two's complement, which wraps. A division by 0
// gives 0, and so does its remainder. Shifts use the low five bits of the count.
std::int32_t apply(Op op, std::int32_t a, std::int32_t b, std::int32_t c);

// Executes the program of an expression. Returns its result.
std::int32_t evaluate(const Program& program, const std::int32_t* variables, const Memory& memory);

// Executes the program and stores its outputs.
void execute(const Program& program, std::int32_t* variables, const Memory& memory);

}  // namespace racebeam

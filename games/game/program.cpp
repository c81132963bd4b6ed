#include "games/game/program.hpp"

#include <algorithm>

namespace racebeam {
namespace {

constexpr std::uint16_t kBusMask = 0x1FFF;  // the 6507 has thirteen address lines

std::uint32_t bits(std::int32_t value) { return static_cast<std::uint32_t>(value); }
std::int32_t wrapped(std::uint32_t value) { return static_cast<std::int32_t>(value); }

// The lowest number / -1 does not fit: it wraps to itself.
std::int32_t quotient(std::int32_t a, std::int32_t b) {
  if (b == 0) return 0;
  return b == -1 ? wrapped(0u - bits(a)) : a / b;
}

std::int32_t remainder(std::int32_t a, std::int32_t b) { return b == 0 || b == -1 ? 0 : a % b; }

std::uint8_t peek(const Memory& memory, std::int32_t address) {
  return memory.peek ? memory.peek(memory.machine, static_cast<std::uint16_t>(address & kBusMask))
                     : std::uint8_t{0};
}

// The value of one instruction, from those before it.
inline std::int32_t value_of(const Instruction& in, const std::int32_t* values, const std::int32_t* variables,
                             const Memory& memory) {
  const auto a = [&] { return values[in.a]; };
  const auto b = [&] { return values[in.b]; };
  const auto c = [&] { return values[in.c]; };
  switch (in.op) {
    case Op::kConstant: return in.value;
    case Op::kVariable: return variables[in.value];
    case Op::kRam: return memory.ram[in.value];
    case Op::kRamAt: return memory.ram[a() & 0x7F];
    case Op::kMemAt: return peek(memory, a());
    case Op::kBcd: return 10 * (a() >> 4) + (a() & 15);
    case Op::kSigned8: return static_cast<std::int8_t>(a());
    case Op::kUnsigned8: return static_cast<std::uint8_t>(a());
    case Op::kNegate: return wrapped(0u - bits(a()));
    case Op::kNot: return a() == 0;
    case Op::kComplement: return ~a();
    case Op::kAdd: return wrapped(bits(a()) + bits(b()));
    case Op::kSubtract: return wrapped(bits(a()) - bits(b()));
    case Op::kMultiply: return wrapped(bits(a()) * bits(b()));
    case Op::kDivide: return quotient(a(), b());
    case Op::kRemainder: return remainder(a(), b());
    case Op::kShiftLeft: return wrapped(bits(a()) << (b() & 31));
    case Op::kShiftRight: return a() >> (b() & 31);
    case Op::kBitAnd: return a() & b();
    case Op::kBitXor: return a() ^ b();
    case Op::kBitOr: return a() | b();
    case Op::kEqual: return a() == b();
    case Op::kNotEqual: return a() != b();
    case Op::kLess: return a() < b();
    case Op::kLessEqual: return a() <= b();
    case Op::kGreater: return a() > b();
    case Op::kGreaterEqual: return a() >= b();
    case Op::kAnd: return a() != 0 && b() != 0;
    case Op::kOr: return a() != 0 || b() != 0;
    case Op::kMin: return std::min(a(), b());
    case Op::kMax: return std::max(a(), b());
    case Op::kSelect: return a() != 0 ? b() : c();
  }
  return 0;
}

// Every value is written before it is read, because operands have lower numbers.
using Values = std::array<std::int32_t, kMaxInstructions>;

void run(const Program& program, Values& values, const std::int32_t* variables, const Memory& memory) {
  std::int32_t* value = values.data();
  for (const Instruction& instruction : program.code)
    *value++ = value_of(instruction, values.data(), variables, memory);
}

}  // namespace

std::optional<RamMask> ram_read_by(const Program& program) {
  RamMask read{};
  for (const Instruction& instruction : program.code) {
    if (instruction.op == Op::kMemAt) return std::nullopt;
    if (instruction.op == Op::kRamAt) read.fill(0xFF);
    if (instruction.op == Op::kRam) read[static_cast<std::size_t>(instruction.value)] = 0xFF;
  }
  return read;
}

std::int32_t apply(Op op, std::int32_t a, std::int32_t b, std::int32_t c) {
  const std::array operands = {a, b, c};
  return value_of({.op = op, .a = 0, .b = 1, .c = 2}, operands.data(), nullptr, {});
}

std::int32_t evaluate(const Program& program, const std::int32_t* variables, const Memory& memory) {
  Values values;
  run(program, values, variables, memory);
  return values[program.result];
}

void execute(const Program& program, std::int32_t* variables, const Memory& memory) {
  Values values;
  run(program, values, variables, memory);
  for (const Output& output : program.outputs) variables[output.variable] = values[output.from];
}

}  // namespace racebeam

#include "games/language/expression.hpp"

#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "games/game/mode_program.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

struct Binary {
  std::string_view symbol;
  int level;  // higher binds tighter
  Op op;
};

constexpr int kLoosest = 1, kComparison = 3;

constexpr std::array kBinaries = {
    Binary{"||", 1, Op::kOr},         Binary{"&&", 2, Op::kAnd},          Binary{"==", 3, Op::kEqual},
    Binary{"!=", 3, Op::kNotEqual},   Binary{"<", 3, Op::kLess},          Binary{"<=", 3, Op::kLessEqual},
    Binary{">", 3, Op::kGreater},     Binary{">=", 3, Op::kGreaterEqual}, Binary{"|", 4, Op::kBitOr},
    Binary{"^", 5, Op::kBitXor},      Binary{"&", 6, Op::kBitAnd},        Binary{"<<", 7, Op::kShiftLeft},
    Binary{">>", 7, Op::kShiftRight}, Binary{"+", 8, Op::kAdd},           Binary{"-", 8, Op::kSubtract},
    Binary{"*", 9, Op::kMultiply},    Binary{"/", 9, Op::kDivide},        Binary{"%", 9, Op::kRemainder},
};

struct Unary {
  std::string_view symbol;
  Op op;
};

constexpr std::array kUnaries = {Unary{"-", Op::kNegate}, Unary{"!", Op::kNot}, Unary{"~", Op::kComplement}};

struct Function {
  std::string_view name;
  int arguments;
  Op op;
};

constexpr std::array kFunctions = {Function{"if", 3, Op::kSelect}, Function{"min", 2, Op::kMin},
                                   Function{"max", 2, Op::kMax}, Function{"s8", 1, Op::kSigned8},
                                   Function{"u8", 1, Op::kUnsigned8}};

constexpr int kFirstRamAddress = 0x80, kLastRamAddress = 0xFF;
constexpr int kDeepest = 500;  // levels of operators and parentheses, so that no text can exhaust the stack
constexpr int kMaxSumTerms = 4096;                // of one expression, in total
constexpr std::ptrdiff_t kMaxReread = 1'000'000;  // tokens of its sums, for all terms but the first of each

class Compiler {
 public:
  Compiler(TokenReader& reader, Scope& scope, ProgramBuilder& builder)
      : in_(reader), scope_(scope), out_(builder) {}

  Register expression(int level = kLoosest) {
    const Nesting nesting(*this);
    Register sum = unary();
    bool compared = false;
    while (const Binary* binary = operator_ahead(level)) {
      if (binary->level == kComparison && compared)
        in_.refuse("comparisons cannot be chained: put the first one in parentheses");
      compared = binary->level == kComparison;
      in_.next();
      sum = emit({.op = binary->op, .a = sum, .b = expression(binary->level + 1)});
    }
    return sum;
  }

 private:
  struct Nesting {
    explicit Nesting(Compiler& in) : compiler(in) {
      if (++compiler.depth_ > kDeepest) compiler.in_.refuse("the expression is nested too deeply");
    }
    ~Nesting() { --compiler.depth_; }
    Compiler& compiler;
  };

  const Binary* operator_ahead(int level) const {
    for (const Binary& binary : kBinaries)
      if (binary.level >= level && in_.is(binary.symbol)) return &binary;
    return nullptr;
  }

  Register unary() {
    const Nesting nesting(*this);
    for (const Unary& sign : kUnaries)
      if (in_.accept(sign.symbol)) return emit({.op = sign.op, .a = unary()});
    return primary();
  }

  Register primary() {
    if (in_.peek().kind == Token::Kind::kNumber) return constant(in_.next().value);
    if (in_.accept("(")) return closed(expression(), ")");
    if (in_.peek().kind != Token::Kind::kName) in_.refuse("expected a value, found " + described(in_.peek()));
    if (in_.is("[", 1)) return memory();
    return in_.is("(", 1) ? call() : name();
  }

  Register closed(Register value, std::string_view bracket) {
    in_.expect(bracket, "after the expression");
    return value;
  }

  Register constant(std::int32_t value) { return emit({.op = Op::kConstant, .value = value}); }

  Register emit(const Instruction& instruction) {
    try {
      return out_.emit(instruction);
    } catch (const std::length_error& error) {
      in_.refuse(error.what());
    }
  }

  // ram[...] and mem[...]

  Register memory() {
    const bool is_ram = in_.is("ram");
    if (!is_ram && !in_.is("mem"))
      in_.refuse(described(in_.peek()) + " cannot be indexed: only ram and mem can");
    if (scope_.purpose == Purpose::kAnswer)
      in_.refuse("memory can be read in 'step' only; assign what you need to a variable there");
    in_.next();
    in_.next();
    const Register address = closed(expression(), "]");
    return is_ram ? ram(address) : emit({.op = Op::kMemAt, .a = address});
  }

  Register ram(Register address) {
    const std::optional<std::int32_t> fixed = out_.constant_value(address);
    if (!fixed) return emit({.op = Op::kRamAt, .a = address});
    if (*fixed < kFirstRamAddress || *fixed > kLastRamAddress)
      in_.refuse("RAM lies at 0x80 to 0xFF, not at " + std::to_string(*fixed));
    return emit({.op = Op::kRam, .value = *fixed - kFirstRamAddress});
  }

  // name(...)

  Register call() {
    for (const Function& function : kFunctions)
      if (in_.is(function.name)) return plain_call(function);
    if (in_.is("bcd")) return bcd();
    if (in_.is("wrap")) return wrap();
    if (in_.is("sum")) return sum();
    if (in_.is("prev")) return previous();
    if (in_.is("rng")) return random();
    in_.refuse("unknown function " + described(in_.peek()) +
               "; accepted: bcd, wrap, prev, if, min, max, s8, u8 and sum");
  }

  Register plain_call(const Function& function) {
    enter_call();
    std::array<Register, 3> argument{};
    for (int i = 0; i < function.arguments; ++i) {
      if (i > 0) in_.expect(",", "between the arguments of " + std::string(function.name) + "()");
      argument[static_cast<std::size_t>(i)] = expression();
    }
    leave_call(function.name);
    return emit({.op = function.op, .a = argument[0], .b = argument[1], .c = argument[2]});
  }

  void enter_call() {
    in_.next();
    in_.next();
  }

  void leave_call(std::string_view name) {
    in_.expect(")", "after the arguments of " + std::string(name) + "()");
  }

  Register bcd() {
    if (scope_.purpose == Purpose::kAnswer)
      in_.refuse("memory can be read in 'step' only; assign what you need to a variable there");
    enter_call();
    Register total = bcd_byte();
    for (std::int32_t weight : {100, 10000}) {
      if (!in_.accept(",")) break;
      const Register part = emit({.op = Op::kMultiply, .a = bcd_byte(), .b = constant(weight)});
      total = emit({.op = Op::kAdd, .a = total, .b = part});
    }
    leave_call("bcd");
    return total;
  }

  Register wrap() {
    enter_call();
    const Register change = expression();
    in_.expect(",", "between the arguments of wrap()");
    const std::optional<std::int32_t> modulus = out_.constant_value(expression());
    if (!modulus || *modulus < kMinModulus)
      in_.refuse("wrap() takes a constant of at least " + std::to_string(kMinModulus) +
                 " second: where the counter starts again");
    leave_call("wrap");
    return emit_wrapped(out_, change, *modulus);
  }

  Register bcd_byte() { return emit({.op = Op::kBcd, .a = ram(expression())}); }

  Register previous() {
    if (scope_.purpose != Purpose::kStep) in_.refuse("prev() is only accepted in 'step'");
    enter_call();
    const std::string_view name = variable_name();
    leave_call("prev");
    return before_step(name);
  }

  Register random() {
    if (scope_.purpose != Purpose::kMode) in_.refuse("rng() is only accepted in a mode program");
    if (std::exchange(scope_.draws, true)) in_.refuse("rng() can be used once in an expression");
    enter_call();
    leave_call("rng");
    return emit({.op = Op::kVariable, .value = kRandomSlot});
  }

  // sum(i, first, last, e): e is compiled once for each i, so that programs need no loops.

  Register sum() {
    enter_call();
    const std::string index(bound_name());
    in_.expect(",", "after the name that sum() binds");
    const std::int32_t first = bound("first");
    const std::int32_t last = bound("last");
    const Token* body = in_.place();
    const auto outer = scope_.values.extract(index);
    Register total = term(index, first);
    for (std::int64_t i = std::int64_t{first} + 1; i <= last; ++i) {
      go_back(body);
      total = emit({.op = Op::kAdd, .a = total, .b = term(index, static_cast<std::int32_t>(i))});
    }
    scope_.values.erase(index);
    if (outer) scope_.values.emplace(outer.key(), outer.mapped());
    leave_call("sum");
    return last < first ? constant(0) : total;
  }

  void go_back(const Token* body) {
    if ((reread_ += in_.place() - body) > kMaxReread) in_.refuse("sums are too long");
    in_.go_to(body);
  }

  std::string_view bound_name() {
    if (in_.peek().kind != Token::Kind::kName)
      in_.refuse("sum() takes a name first, found " + described(in_.peek()));
    return in_.next().text;
  }

  std::int32_t bound(const std::string& which) {
    const std::optional<std::int32_t> value = out_.constant_value(expression());
    if (!value) in_.refuse("the " + which + " index of sum() must be a constant");
    in_.expect(",", "after the " + which + " index of sum()");
    return *value;
  }

  Register term(const std::string& index, std::int32_t value) {
    if (++terms_ > kMaxSumTerms)
      in_.refuse("sums of more than " + std::to_string(kMaxSumTerms) + " terms are too long");
    scope_.values[index] = constant(value);
    return expression();
  }

  // Names

  std::string_view variable_name() {
    const Token& token = in_.peek();
    if (token.kind != Token::Kind::kName)
      in_.refuse("expected the name of a variable, found " + described(token));
    if (!scope_.names.knows(token.text)) in_.refuse("nothing assigns " + described(token));
    return in_.next().text;
  }

  Register name() {
    const auto value = scope_.values.find(in_.peek().text);
    if (value != scope_.values.end()) return in_.next(), value->second;
    const auto local = scope_.locals.find(in_.peek().text);
    if (local != scope_.locals.end()) return in_.next(), emit({.op = Op::kVariable, .value = local->second});
    return before_step(variable_name());
  }

  Register before_step(std::string_view name) {
    try {
      return emit({.op = Op::kVariable, .value = scope_.names.slot(name)});
    } catch (const SourceError&) {
      throw;
    } catch (const InvalidInput& error) {
      in_.refuse(error.what());
    }
  }

  TokenReader& in_;
  Scope& scope_;
  ProgramBuilder& out_;
  int depth_ = 0;
  int terms_ = 0;
  std::ptrdiff_t reread_ = 0;  // tokens
};

}  // namespace

Register emit_wrapped(ProgramBuilder& out, Register change, std::int32_t modulus) {
  const Register turn = out.constant(modulus), far = out.constant(modulus - modulus / 10);
  const Register down =
      out.emit({.op = Op::kLessEqual, .a = change, .b = out.emit({.op = Op::kNegate, .a = far})});
  const Register up = out.emit({.op = Op::kGreaterEqual, .a = change, .b = far});
  const Register after_down = out.emit({.op = Op::kAdd, .a = change, .b = turn});
  const Register after_up = out.emit({.op = Op::kSubtract, .a = change, .b = turn});
  const Register not_down = out.emit({.op = Op::kSelect, .a = up, .b = after_up, .c = change});
  return out.emit({.op = Op::kSelect, .a = down, .b = after_down, .c = not_down});
}

Register compile_expression(TokenReader& reader, Scope& scope, ProgramBuilder& builder) {
  return Compiler(reader, scope, builder).expression();
}

}  // namespace racebeam

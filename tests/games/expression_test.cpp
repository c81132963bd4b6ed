#include <catch2/catch.hpp>

#include <limits>
#include <string>
#include <vector>

#include "games/language/lexer.hpp"
#include "games/language/rule_compiler.hpp"
#include "tests/games/game_text.hpp"

using namespace racebeam;
using Catch::Contains;

namespace {

constexpr int kLowest = std::numeric_limits<int>::min(), kHighest = std::numeric_limits<int>::max();

// The value of an expression of constants, which the compiler folds.
int folded(const std::string& expression) {
  const Game game = game_with_step("reward = " + expression + "\nterminal = 0");
  Rule rule(game);
  rule.step(FakeMemory{}.memory());
  return rule.reward();
}

// Computes the expression with X and Y as variables, so that the program does it.
int computed(const std::string& expression, int x, int y) {
  const std::string first = "reset = { X = " + std::to_string(x) + ", Y = " + std::to_string(y) + " }";
  const Game game = game_with_step("both = X + Y\nreward = " + expression + "\nterminal = 0", first);
  Rule rule(game);
  rule.step(FakeMemory{}.memory());
  return rule.reward();
}

std::string bracketed(int value) { return std::string("(").append(std::to_string(value)).append(")"); }

int error_line(const std::string& step) {
  try {
    RuleCompiler().step(step);
  } catch (const SourceError& error) {
    return error.line;
  }
  return 0;
}

std::string error_of(const std::string& expression) {
  try {
    RuleCompiler().step("terminal = 0\nreward = " + expression);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("every operator gives the same when it is folded and when it is computed") {
  struct Case {
    const char* sign;
    int x, y, result;
  };
  const Case cases[] = {
      {"+", 7, 3, 10},  {"-", 7, 3, 4},   {"*", 7, 3, 21},  {"/", 7, 3, 2},    {"%", 7, 3, 1},
      {"<<", 7, 3, 56}, {">>", 56, 3, 7}, {"&", 12, 10, 8}, {"|", 12, 10, 14}, {"^", 12, 10, 6},
      {"==", 5, 5, 1},  {"==", 5, 6, 0},  {"!=", 5, 6, 1},  {"!=", 5, 5, 0},   {"<", 5, 6, 1},
      {"<", 6, 6, 0},   {"<=", 6, 6, 1},  {"<=", 7, 6, 0},  {">", 6, 5, 1},    {">", 6, 6, 0},
      {">=", 6, 6, 1},  {">=", 5, 6, 0},  {"&&", 2, 4, 1},  {"&&", 2, 0, 0},   {"||", 0, 4, 1},
      {"||", 0, 0, 0},  {"/", 7, 0, 0},   {"%", 7, 0, 0},   {"<<", 1, 33, 2},  {">>", -8, 1, -4},
      {"/", -7, 2, -3}, {"%", -7, 2, -1}, {"/", -7, -1, 7}, {"%", -7, -1, 0},  {"<<", 1, 31, kLowest},
  };
  for (const Case& each : cases) {
    INFO(each.x << " " << each.sign << " " << each.y);
    const std::string sign = each.sign;
    CHECK(folded(bracketed(each.x) + sign + bracketed(each.y)) == each.result);
    CHECK(computed("X " + sign + " Y", each.x, each.y) == each.result);
  }
}

TEST_CASE("unary operators and functions give the same when folded and when computed") {
  struct Case {
    const char* text;
    int x, y, result;
  };
  const Case cases[] = {
      {"-X", 5, 0, -5},         {"!X", 5, 0, 0},           {"!X", 0, 0, 1},          {"~X", 5, 0, -6},
      {"min(X, Y)", 3, -4, -4}, {"max(X, Y)", 3, -4, 3},   {"s8(X)", 0x1FF, 0, -1},  {"s8(X)", 127, 0, 127},
      {"u8(X)", -1, 0, 255},    {"u8(X)", 0x1FE, 0, 0xFE}, {"if(X, Y, 9)", 1, 4, 4}, {"if(X, Y, 9)", 0, 4, 9},
      {"- - X", 5, 0, 5},       {"!!X", 7, 0, 1},
  };
  for (const Case& each : cases) {
    INFO(each.text << " with x = " << each.x << ", y = " << each.y);
    CHECK(computed(each.text, each.x, each.y) == each.result);
    std::string constant;
    for (const char c : std::string(each.text))
      constant += c == 'X' ? bracketed(each.x) : c == 'Y' ? bracketed(each.y) : std::string(1, c);
    CHECK(folded(constant) == each.result);
  }
}

TEST_CASE("arithmetic wraps around in 32 bits") {
  CHECK(computed("X + Y", kHighest, 1) == kLowest);
  CHECK(computed("X - Y", kLowest, 1) == kHighest);
  CHECK(computed("X * Y", 65536, 65536) == 0);
  CHECK(computed("X * Y", 46341, 46341) == -2147479015);
  CHECK(computed("-X", kLowest, 0) == kLowest);
  CHECK(computed("X / Y", kLowest, -1) == kLowest);
  CHECK(computed("X % Y", kLowest, -1) == 0);
  CHECK(folded("0xFFFFFFFF") == -1);
  CHECK(folded("0X7fffffff") == kHighest);
  CHECK(folded("2147483647") == kHighest);
}

TEST_CASE("operators bind as the catalogue's README says") {
  CHECK(folded("2 + 3 * 4") == 14);
  CHECK(folded("(2 + 3) * 4") == 20);
  CHECK(folded("20 - 5 - 3") == 12);
  CHECK(folded("100 / 5 * 2") == 40);
  CHECK(folded("1 << 2 + 1") == 8);
  CHECK(folded("7 & 1 << 1") == 2);
  CHECK(folded("1 | 2 ^ 3 & 2") == (1 | (2 ^ (3 & 2))));
  CHECK(folded("6 & 3 == 2") == 1);
  CHECK(folded("1 || 0 && 0") == 1);
  CHECK(folded("1 < 2 && 3 < 2") == 0);
  CHECK(folded("!0 + 1") == 2);
  CHECK(folded("-2 * 3") == -6);
  CHECK(folded("~0 & 15") == 15);
}

TEST_CASE("each operator binds tighter than those below it, and as tight as those beside it, from the left") {
  const std::vector<std::vector<std::string>> loosest_first = {
      {"||"},     {"&&"},         {"==", "!=", "<", "<=", ">", ">="}, {"|"}, {"^"}, {"&"}, {"<<", ">>"},
      {"+", "-"}, {"*", "/", "%"}};
  const std::string operands[][3] = {{"7", "2", "3"}, {"4", "0", "1"}, {"1", "6", "2"}, {"9", "5", "5"}};
  const std::size_t comparisons = 2;
  for (std::size_t left = 0; left < loosest_first.size(); ++left)
    for (std::size_t right = 0; right < loosest_first.size(); ++right) {
      if (left == right && left == comparisons) continue;  // they cannot be chained
      for (const std::string& first : loosest_first[left])
        for (const std::string& second : loosest_first[right])
          for (const auto& [a, b, c] : operands) {
            const std::string open = a + first + b + second + c;
            const std::string grouped = right > left ? a + first + "(" + b + second + c + ")"
                                                     : "(" + a + first + b + ")" + second + c;
            INFO(open);
            REQUIRE(folded(open) == folded(grouped));
          }
    }
}

TEST_CASE("ram, mem and bcd read memory") {
  FakeMemory memory;
  memory[0x80] = 0x12;
  memory[0x81] = 0x34;
  memory[0xFF] = 0xAB;
  memory[0x90] = 0x81;
  const auto value = [&](const std::string& expression) {
    const Game game = game_with_step("reward = " + expression + "\nterminal = 0");
    Rule rule(game);
    rule.step(memory.memory());
    return rule.reward();
  };
  CHECK(value("ram[0x80]") == 0x12);
  CHECK(value("ram[255]") == 0xAB);
  CHECK(value("ram[ram[0x90]]") == 0x34);
  CHECK(value("ram[0x7F + 1]") == 0x12);
  CHECK(value("mem[0x10FE]") == 0xFE);
  CHECK(value("mem[0xF0B4] + mem[ram[0x80]]") == 0xB4 + 0x12);
  CHECK(value("bcd(0x80)") == 12);
  CHECK(value("bcd(0x80, 0x81)") == 3412);
  CHECK(value("bcd(0x80, 0x81, 0x90)") == 813412);
  CHECK(value("bcd(0xFF)") == 10 * 10 + 11);  // digits above 9 count as they are
}

TEST_CASE("sum binds its name, also within another sum, and hides a variable of that name") {
  CHECK(folded("sum(i, 1, 4, i * i)") == 30);
  CHECK(folded("sum(i, 5, 4, i)") == 0);
  CHECK(folded("sum(i, 1, 3, sum(k, 1, i, 10 * i + k))") == 11 + 21 + 22 + 31 + 32 + 33);
  CHECK(folded("sum(i, 1, 2, sum(i, 1, 2, i) + i)") == 9);
  CHECK(computed("sum(X, 1, 2, X) + X", 100, 0) == 103);
  FakeMemory memory;
  memory[0x85] = memory[0x86] = 1;
  const Game game = game_with_step("reward = sum(a, 0x80, 0xFF, ram[a] == 0)\nterminal = 0");
  Rule rule(game);
  rule.step(memory.memory());
  CHECK(rule.reward() == 126);
}

TEST_CASE("lines may be broken inside parentheses, and comments are skipped") {
  CHECK(folded("(1 + # one\n  2)\n# nothing here") == 3);
}

TEST_CASE("tabs and the line ends of other systems are blanks") {
  CHECK(folded("\t1\t+\t2\t\r") == 3);
  CHECK(folded("(1 +\r\n\t2)") == 3);
}

TEST_CASE("what cannot be an expression is refused with the word that is wrong") {
  CHECK_THAT(error_of("1 +"), Contains("expected a value") && Contains("end of the line"));
  CHECK_THAT(error_of("(1"), Contains("expected ')'"));
  CHECK_THAT(error_of("1 2"), Contains("'2'"));
  CHECK_THAT(error_of("scor"), Contains("nothing assigns 'scor'"));
  CHECK_THAT(error_of("prev(scor)"), Contains("nothing assigns 'scor'"));
  CHECK_THAT(error_of("mode"), Contains("nothing assigns 'mode'"));
  CHECK_THAT(error_of("foo(1)"), Contains("unknown function 'foo'"));
  CHECK_THAT(error_of("rng()"), Contains("rng()"));
  CHECK_THAT(error_of("min(1)"), Contains("expected ','") && Contains("min()"));
  CHECK_THAT(error_of("bcd(0x80, 0x81, 0x82, 0x83)"), Contains("expected ')'") && Contains("bcd()"));
  CHECK_THAT(error_of("reward[1]"), Contains("only ram and mem"));
  CHECK_THAT(error_of("ram[0x7F]"), Contains("0x80 to 0xFF"));
  CHECK_THAT(error_of("ram[256]"), Contains("0x80 to 0xFF"));
  CHECK_THAT(error_of("1 < 2 < 3"), Contains("chained"));
  CHECK_THAT(error_of("2147483648"), Contains("'2147483648' is not a number"));
  CHECK_THAT(error_of("0x100000000"), Contains("is not a number"));
  CHECK_THAT(error_of("12ab"), Contains("'12ab' is not a number"));
  CHECK_THAT(error_of("1 ? 2"), Contains("'?'"));
  CHECK_THAT(error_of("sum(i, 0, ram[0x80], i)"), Contains("must be a constant"));
  CHECK_THAT(error_of("sum(1, 0, 3, 2)"), Contains("takes a name"));
  std::string ones = "1";
  for (int i = 0; i < 1000; ++i) ones += " + 1";
  CHECK_THAT(error_of("sum(i, 1, 4000, " + ones + ")"), Contains("sums are too long"));
}

TEST_CASE("a counter that wraps has at least ten values") {
  CHECK(folded("wrap(-9, 10)") == 1);
  CHECK_THAT(error_of("wrap(-9, 9)"), Contains("wrap() takes a constant of at least 10"));
}

TEST_CASE("mem is 0 where only RAM is known") {
  const Game game = game_with_step("reward = mem[0x1234] + ram[0x80]\nterminal = 0");
  Rule rule(game);
  FakeMemory memory;
  memory[0x80] = 7;
  rule.step({memory.ram.data()});
  CHECK(rule.reward() == 7);
}

TEST_CASE("no expression can exhaust the compiler") {
  CHECK_THAT(error_of(std::string(100000, '(')), Contains("nested too deeply"));
  CHECK_THAT(error_of(std::string(100000, '-') + "1"), Contains("nested too deeply"));
  // Five hundred levels: the expression, the number, and a sign or two levels of brackets each.
  CHECK(folded(std::string(498, '-') + "1") == 1);
  CHECK_THAT(error_of(std::string(499, '-') + "1"), Contains("nested too deeply"));
  CHECK(folded(std::string(249, '(') + "1" + std::string(249, ')')) == 1);
  CHECK_THAT(error_of(std::string(250, '(') + "1"), Contains("nested too deeply"));
  const std::string most_terms = "sum(i, 1, 64, sum(k, 1, 63, 1))";  // 64 and 64 * 63
  CHECK(folded(most_terms) == 64 * 63);
  CHECK_THAT(error_of(most_terms + " + sum(i, 1, 1, 1)"),
             Contains("sums of more than 4096 terms are too long"));
  CHECK_THAT(error_of("sum(i, 0, 2147483647, 1)"), Contains("too long"));
  CHECK_THAT(error_of("sum(i, 0, 255, sum(k, 0, 255, 1))"), Contains("too long"));
  CHECK_THAT(error_of("sum(i, 0, 4000, ram[0x80 + i % 128] * i)"), Contains("too long"));
}

TEST_CASE("errors know their line") {
  CHECK(error_line("terminal = 0\n\nreward = 1 +\n") == 3);
  CHECK(error_line("terminal = 0\nreward = (1 +\n  nobody)\n") == 3);
  CHECK(error_line("terminal = 0\n= 3\n") == 2);
  CHECK(error_line("terminal = 0\nif = 3\n") == 2);
}

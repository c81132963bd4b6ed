// Addition, subtraction and related undocumented instructions: all pairs of operands, with and without
// decimal mode and carry.
#include <catch2/catch.hpp>

#include "tests/emulator/bench.hpp"
#include "tests/emulator/reference/reference_cpu.hpp"

namespace racebeam::test {
namespace {

// The model's own memory. The bench's program and operand are in RAM, at the same addresses.
struct FlatBus : Bus {
  std::array<int, 0x10000> memory{};
  int read(int address, int) override { return memory[static_cast<std::size_t>(address)]; }
  int write(int address, int value, int T, bool) override {
    memory[static_cast<std::size_t>(address)] = value;
    return T;
  }
};

constexpr int kProgram = 0x80, kOperand = 0x90;

struct Case {
  const char* name;
  int opcode;
  bool immediate;
};

constexpr Case kCases[] = {{"ADC", 0x69, true},  {"SBC", 0xE9, true}, {"sbc", 0xEB, true},
                           {"arr", 0x6B, true},  {"CMP", 0xC9, true}, {"sbx", 0xCB, true},
                           {"asr", 0x4B, true},  {"anc", 0x0B, true}, {"rra", 0x67, false},
                           {"isb", 0xE7, false}, {"dcp", 0xC7, false}};

class Pairs {
 public:
  explicit Pairs(const Case& c) : case_(c), x_(0x5B) {
    put(kProgram, c.opcode);
    put(kProgram + 1, kOperand);
  }

  void check(int a, int m, int flags) {
    put(case_.immediate ? kProgram + 1 : kOperand, m);
    CpuState& cpu = bench_.cpu;
    cpu.PC = static_cast<std::uint16_t>(model_.PC = kProgram);
    cpu.A = static_cast<std::uint8_t>(model_.A = a);
    cpu.X = static_cast<std::uint8_t>(model_.X = x_);
    cpu.P = static_cast<std::uint8_t>(flags);
    model_.set_status(flags);
    bench_.run(1);
    model_.step();
    const bool same = cpu.A == model_.A && cpu.X == model_.X && (cpu.P | 0x30) == model_.status() &&
                      bench_.state.riot.ram[kOperand - 0x80] == bus_.memory[kOperand];
    if (!same)
      FAIL("A " << a << ", operand " << m << ", P " << flags << ": A is " << int{cpu.A} << ", not "
                << model_.A << "; P is " << (cpu.P | 0x30) << ", not " << model_.status());
  }

 private:
  void put(int address, int value) {
    bus_.memory[static_cast<std::size_t>(address)] = value;
    bench_.state.riot.ram[static_cast<std::size_t>(address - 0x80)] = static_cast<std::uint8_t>(value);
  }

  const Case& case_;
  int x_;
  Bench bench_;
  FlatBus bus_;
  ReferenceCpu model_{bus_};
};

TEST_CASE("Arithmetic gives what the specification says for all operands") {
  for (const Case& c : kCases) {
    INFO(c.name);
    Pairs pairs(c);
    for (const int flags : {0x00, 0x01, 0x08, 0x09})  // carry and decimal mode
      for (int a = 0; a < 256; ++a)
        for (int m = 0; m < 256; ++m) pairs.check(a, m, flags);
  }
}

// Tests the model itself with values that were observed on the reference (docs/spec/cpu.md, "How to check", 1
// to 3).
TEST_CASE("Decimal arithmetic gives the observed values") {
  struct Observed {
    int opcode, a, m, carry, result, status;
  };
  constexpr Observed kObserved[] = {{0x69, 0x99, 0x01, 0, 0x00, 0x3B},
                                    {0xE9, 0x00, 0xFF, 0, 0x7C, 0x38},
                                    {0x69, 0x0F, 0x0F, 1, 0x31, 0x38},
                                    {0x69, 0xFF, 0xFF, 0, 0x74, 0x79}};
  for (const Observed& o : kObserved) {
    Bench bench;
    bench.state.riot.ram[0] = static_cast<std::uint8_t>(o.opcode);
    bench.state.riot.ram[1] = static_cast<std::uint8_t>(o.m);
    bench.cpu.PC = 0x80;
    bench.cpu.A = static_cast<std::uint8_t>(o.a);
    bench.cpu.P = static_cast<std::uint8_t>(8 | o.carry);
    bench.run(1);
    INFO("A " << o.a << ", operand " << o.m);
    CHECK(int{bench.cpu.A} == o.result);
    CHECK((bench.cpu.P | 0x30) == o.status);
  }
}

}  // namespace
}  // namespace racebeam::test

// The cases of docs/spec/cpu.md, "How to check", and how a run ends.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A 4K image with this at $F000, where a reset starts it; BRK leads to $F800.
Rom image(const Bytes& program) {
  Rom rom(4096, 0xEA);
  std::copy(program.begin(), program.end(), rom.begin());
  const Bytes vectors = {0x00, 0xF0, 0x00, 0xF8};
  std::copy(vectors.begin(), vectors.end(), rom.end() - 4);
  rom[0xF00] = 0x01;  // the halves differ: 4K
  return rom;
}

Bench ran(const Bytes& program, int instructions) {
  Bench bench(image(program));
  bench.run(instructions);
  return bench;
}

std::uint8_t ram(const Bench& bench, unsigned address) { return bench.board.state.riot.ram[address & 0x7F]; }

TEST_CASE("Cases 1 to 3: decimal mode") {
  struct Case {
    Bytes program;
    int a, pushed;
  };
  const Case cases[] = {{{0xF8, 0x18, 0xA9, 0x99, 0x69, 0x01, 0x08}, 0x00, 0x3B},
                        {{0xF8, 0x18, 0xA9, 0x00, 0xE9, 0xFF, 0x08}, 0x7C, 0x38},
                        {{0xF8, 0x18, 0xA9, 0xFF, 0x69, 0xFF, 0x08}, 0x74, 0x79}};
  for (const Case& c : cases) {
    const Bench bench = ran(c.program, 5);
    CHECK(int{bench.cpu.A} == c.a);
    CHECK(int{ram(bench, 0x1FF)} == c.pushed);
  }
  CHECK(int{ran({0xF8, 0x38, 0xA9, 0x0F, 0x69, 0x0F}, 4).cpu.A} == 0x31);
}

TEST_CASE("Case 4: a TIA read shows the bus where the TIA drives nothing") {
  struct Case {
    Bytes program;
    int instructions, a;
  };
  const Case cases[] = {{{0xAD, 0x02, 0x2F}, 1, 0x2F},               // LDA $2F02
                        {{0xA5, 0x02}, 1, 0x02},                     // LDA $02
                        {{0xA2, 0x02, 0xB5, 0x00}, 2, 0x00},         // LDX #2, LDA $00,X
                        {{0xA2, 0x02, 0xBD, 0x00, 0x01}, 2, 0x01}};  // LDX #2, LDA $0100,X
  for (const Case& c : cases) CHECK(int{ran(c.program, c.instructions).cpu.A} == c.a);

  Bench bench(image({0xB1, 0x90}));  // LDA ($90),Y
  bench.state.riot.ram[0x10] = 0x33;
  bench.state.riot.ram[0x11] = 0x25;
  bench.run(1);
  CHECK(int{bench.cpu.A} == 0x25);
}

TEST_CASE("Case 5: INC WSYNC writes once and waits") { CHECK(ran({0xE6, 0x02}, 1).state.cycle == 76); }

TEST_CASE("Case 6: a push into WSYNC waits only if it comes after a read") {
  const auto jsr_with_stack_at = [](std::uint8_t sp) { return ran({0xA2, sp, 0x9A, 0x20, 0x00, 0xF1}, 3); };
  CHECK(jsr_with_stack_at(3).state.cycle == 10);
  Bench first_push = jsr_with_stack_at(2);
  CHECK(first_push.state.cycle == 76);
  first_push.end_step();
  CHECK(first_push.state.tia.vblank == 0);  // VBLANK received $05: bits 2 and 0 only
  CHECK(first_push.state.frame.dumping == 0);
  CHECK(int{first_push.cpu.latch} == 0xF1);
}

TEST_CASE("Case 7: BRK") {
  const Bench bench = ran({0x00}, 1);
  CHECK(bench.state.cycle == 7);
  CHECK(int{bench.cpu.SP} == 0xFC);
  CHECK(bench.cpu.PC == 0xF800);
  CHECK(int{ram(bench, 0x1FF)} == 0xF0);
  CHECK(int{ram(bench, 0x1FE)} == 0x02);
  CHECK(int{ram(bench, 0x1FD)} == 0x30);
}

TEST_CASE("Every jam opcode stops the processor until a reset") {
  for (int opcode = 0x02; opcode < 0x100; opcode += 0x10) {
    if (opcode == 0x82 || opcode == 0xA2 || opcode == 0xC2 || opcode == 0xE2) continue;
    INFO("opcode " << opcode);
    Bench bench = ran({static_cast<std::uint8_t>(opcode), 0xE8}, 5);
    CHECK(bench.state.cycle == 2);
    CHECK(bench.cpu.PC == 0xF001);
    bench.run(5);
    CHECK(bench.state.cycle == 2);
    reset_cpu(bench.board);
    CHECK(bench.cpu.PC == 0xF000);
    CHECK(bench.cpu.jammed == 0);
  }
}

TEST_CASE("A run ends after the instruction that closes the frame") {
  // VSYNC on, four times WSYNC, VSYNC off, INX.
  Bench bench = ran(
      {0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x00, 0x85, 0x00, 0xE8},
      100);
  CHECK(bench.board.stop);
  CHECK(bench.cpu.PC == 0xF010);
  CHECK(int{bench.cpu.X} == 0);
}

}  // namespace
}  // namespace racebeam::test

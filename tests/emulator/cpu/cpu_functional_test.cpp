// Runs functional.asm, a program that tests the CPU it runs on.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/emulator/bench.hpp"
#include "tests/emulator/reference/reference_cpu.hpp"

namespace racebeam::test {
namespace {

constexpr std::size_t kStep = 0, kResult = 1;  // in RAM, from $80 on
constexpr std::uint8_t kPassed = 0xA5;

Rom assembled_program() {
  std::ifstream file(RACEBEAM_FUNCTIONAL_PROGRAM, std::ios::binary);
  REQUIRE(file);
  return Rom(std::istreambuf_iterator<char>(file), {});
}

TEST_CASE("The functional program passes all its checks, and runs every documented opcode") {
  const Rom rom = assembled_program();
  Bench bench(rom);
  std::set<int> opcodes;
  for (int i = 0; i < 20000 && !bench.cpu.jammed && bench.state.riot.ram[kResult] != kPassed; ++i) {
    opcodes.insert(rom[bench.cpu.PC & 0xFFF]);
    bench.run(1);
  }
  INFO("failed check (from 0): " << int{bench.state.riot.ram[kStep]});
  CHECK_FALSE(bench.cpu.jammed);
  REQUIRE(bench.state.riot.ram[kResult] == kPassed);
  for (int opcode = 0; opcode < 256; ++opcode) {
    INFO("opcode " << opcode);
    CHECK((opcodes.count(opcode) == 1 || !is_documented(opcode)));
  }
}

TEST_CASE("The functional program passes in one run of many instructions, too") {
  Bench bench(assembled_program());
  bench.run(20000);
  CHECK(bench.state.riot.ram[kResult] == kPassed);
}

}  // namespace
}  // namespace racebeam::test

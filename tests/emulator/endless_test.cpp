// A program that never ends its frame: the clocks of that frame never overflow.
#include <catch2/catch.hpp>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

TEST_CASE("A frame that never closes can go on for ever") {
  Rom rom(4096, 0xEA);
  const std::vector<std::uint8_t> program = {0xEE, 0x80, 0x00, 0xEE, 0x80,
                                             0x00, 0x4C, 0x00, 0xF0};  // INC $80, for ever
  std::copy(program.begin(), program.end(), rom.begin());
  rom[0xFFC] = 0x00, rom[0xFFD] = 0xF0;
  SystemGenerator generator(1);
  Console console(std::make_shared<const Rom>(rom), ntsc(), generator);
  std::int32_t highest = 0;
  for (int i = 0; i < 12000; ++i) {  // 25000 instructions each, 5 cycles in the mean: three times the limit
    console.step();
    highest = std::max(highest, console.state().cycle);
    REQUIRE(console.state().cycle >= 0);
    REQUIRE(console.state().cycle < kEndlessCycle);
  }
  CHECK(highest > kEndlessCycle - 25000 * 8);
  CHECK(console.state().frame.open == 1);
  CHECK_NOTHROW(console.check(console.state()));
}

}  // namespace
}  // namespace racebeam::test

// The cases of docs/spec/riot.md, "How to check", and the decoding of the RIOT's addresses.
#include <catch2/catch.hpp>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

constexpr unsigned kSWCHA = 0x280, kSWACNT = 0x281, kSWCHB = 0x282, kSWBCNT = 0x283, kINTIM = 0x284,
                   kINSTAT = 0x285;
constexpr unsigned kTIM1T = 0x294, kTIM8T = 0x295, kTIM64T = 0x296, kT1024T = 0x297;

struct Read {
  unsigned address;
  int cycle, expected;
};

void check_timer(unsigned reg, unsigned value, int cycle, std::initializer_list<Read> reads) {
  Bench bench;
  bench.write_at(cycle, reg, value);
  for (const Read& read : reads) {
    INFO("register " << reg << " = " << value << ", read of " << read.address << " at " << read.cycle);
    CHECK(int{bench.read_at(read.cycle, read.address)} == read.expected);
  }
}

TEST_CASE("Case 1: RAM and timers at power-on come from the generator") {
  SystemGenerator generator(4753849);
  Console console(std::make_shared<Rom>(4096, std::uint8_t{0x02}), ntsc(), generator);  // JAM: nothing runs
  const std::uint8_t first[] = {0xB8, 0x96, 0xC0, 0x49, 0xCB, 0x55, 0xC8, 0x7F},
                     last[] = {0xAB, 0x14, 0x6F, 0xC0};
  CHECK(std::equal(std::begin(first), std::end(first), console.ram().begin()));
  CHECK(std::equal(std::begin(last), std::end(last), console.ram().end() - 4));
  // Draw 129 was for the construction, 130 and 131 were for the resets.
  CHECK(int{console.state().riot.timer} == 51);
  console.reset();
  CHECK(int{console.state().riot.timer} == 32);
  CHECK(std::equal(std::begin(first), std::end(first), console.ram().begin()));

  SystemGenerator again(4753849);
  std::uint32_t draws = 128;
  CHECK(25 + again.draw(draws) % 75 == 58);
}

TEST_CASE("Case 2: TIM8T through its expiry, read in time") {
  check_timer(kTIM8T, 3, 100,
              {{kINTIM, 101, 0x02},
               {kINTIM, 108, 0x02},
               {kINTIM, 109, 0x01},
               {kINTIM, 117, 0x00},
               {kINTIM, 124, 0x00},
               {kINTIM, 125, 0xFF},
               {kINSTAT, 125, 0x80},
               {kINTIM, 126, 0xFE},
               {kINSTAT, 126, 0x00},
               {kINTIM, 127, 0xFE},
               {kINTIM, 134, 0xFD},
               {kINTIM, 200, 0xF5}});
}

TEST_CASE("Case 3: TIM8T read late for the first time") {
  check_timer(kTIM8T, 3, 100,
              {{kINSTAT, 140, 0x80},
               {kINTIM, 140, 0xEF},
               {kINTIM, 141, 0xEE},
               {kINTIM, 148, 0xEE},
               {kINTIM, 149, 0xED}});
}

TEST_CASE("Case 4: TIM1T") {
  check_timer(kTIM1T, 5, 1000,
              {{kINTIM, 1001, 0x04},
               {kINTIM, 1005, 0x00},
               {kINTIM, 1006, 0xFF},
               {kINTIM, 1007, 0xFD},
               {kINTIM, 1008, 0xFC},
               {kINTIM, 1010, 0xFA},
               {kINTIM, 1300, 0xD8}});
}

TEST_CASE("Case 5: TIM64T, and what clears INSTAT") {
  check_timer(kTIM64T, 2, 2000,
              {{kINSTAT, 2128, 0x00},
               {kINSTAT, 2129, 0x80},
               {kINTIM, 2129, 0xFF},
               {kINSTAT, 2200, 0x80},
               {kINTIM, 2300, 0x52},
               {kINSTAT, 2301, 0x00},
               {kINTIM, 2364, 0x51}});
}

TEST_CASE("Case 6: T1024T, and TIM64T set to 0") {
  check_timer(kT1024T, 1, 3000,
              {{kINTIM, 3001, 0x00},
               {kINTIM, 4024, 0x00},
               {kINTIM, 4025, 0xFF},
               {kINTIM, 4026, 0xFE},
               {kINTIM, 5050, 0xFD},
               {kINTIM, 7000, 0xFC}});
  check_timer(kTIM64T, 0, 3000,
              {{kINTIM, 3001, 0xFF}, {kINTIM, 3002, 0xFE}, {kINTIM, 3003, 0xFE}, {kINTIM, 3100, 0xFD}});
}

TEST_CASE("In the cycle in which it was set, INTIM has the value times the interval") {
  check_timer(kTIM1T, 0x4B, 1000, {{kINTIM, 1000, 0x4B}, {kINSTAT, 1000, 0x00}, {kINTIM, 1001, 0x4A}});
  check_timer(kTIM8T, 0x4B, 1000, {{kINTIM, 1000, 0x58}, {kINSTAT, 1000, 0x80}, {kINTIM, 1001, 0x4A}});
  check_timer(kTIM64T, 0x4B, 1000, {{kINTIM, 1000, 0xC0}, {kINSTAT, 1000, 0x80}, {kINTIM, 1001, 0x4A}});
  check_timer(kT1024T, 0x4B, 1000, {{kINTIM, 1000, 0x00}, {kINSTAT, 1000, 0x80}, {kINTIM, 1001, 0x4A}});
  check_timer(kTIM8T, 0xF3, 1000, {{kINTIM, 1000, 0x98}});
  // Such a read is not the late one that decides how the timer goes on, and that INSTAT sees.
  check_timer(kTIM64T, 2, 2000, {{kINTIM, 2000, 0x80}, {kINSTAT, 2129, 0x80}, {kINTIM, 2300, 0x52}});
}

TEST_CASE("Case 7: the ports") {
  Bench bench;
  bench.write_at(10, kSWACNT, 0xFF);
  bench.write_at(13, kSWCHA, 0x00);
  bench.write_at(16, kSWBCNT, 0xFF);
  CHECK(int{bench.read_at(20, kSWCHA)} == 0xFF);
  CHECK(int{bench.read_at(20, kSWACNT)} == 0xFF);
  CHECK(int{bench.read_at(20, kSWBCNT)} == 0x00);
  CHECK(int{bench.read_at(20, kSWCHB)} == 0x3F);
  bench.state.inputs.joystick = {kStickUp | kStickRight, kStickLeft};
  bench.state.inputs.switches = static_cast<std::uint8_t>((kSwitchesAtRest & ~kSwitchReset) | kSwitchLeftA);
  CHECK(int{bench.read_at(30, kSWCHA)} == 0x6B);
  CHECK(int{bench.read_at(30, kSWCHB)} == 0x7E);
}

TEST_CASE("Reads ignore A3 and A4, writes below $284 ignore A4, and timers need it") {
  Bench bench;
  bench.write_at(0, 0x291, 0x5A);  // SWACNT by its mirror
  for (const unsigned mirror : {0x281U, 0x289U, 0x291U, 0x299U, 0x2F9U, 0x681U})
    CHECK(int{bench.read_at(10, mirror)} == 0x5A);
  bench.write_at(100, kTIM1T, 200);
  bench.write_at(110, 0x284, 7);  // edge detection, not a timer
  for (const unsigned mirror : {0x284U, 0x286U, 0x28CU, 0x294U, 0x29EU})
    CHECK(int{bench.read_at(121, mirror)} == 200 - 21);
  bench.write_at(200, 0x29C, 50);  // A3 is not decoded
  CHECK(int{bench.read_at(201, kINTIM)} == 49);
}

TEST_CASE("A frame's start leaves the timer's reading as it was") {
  for (const int close : {1000, 19912}) {
    Bench same, next;
    for (Bench* bench : {&same, &next}) {
      bench->write_at(900, kTIM8T, 10);
      bench->read_at(990, kINTIM);
    }
    next.next_frame(close);
    for (const int later : {0, 1, 8, 100, 3000})
      CHECK(next.read_at(later, kINTIM) == same.read_at(close + later, kINTIM));
  }
}

}  // namespace
}  // namespace racebeam::test

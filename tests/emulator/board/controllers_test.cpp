// docs/spec/controllers.md, 2: what the pins of each controller read.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <vector>

#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

constexpr unsigned kSWCHA = 0x280, kSWACNT = 0x281, kVBLANK = 1;
constexpr unsigned kINPT0 = 8, kINPT1 = 9, kINPT2 = 10, kINPT3 = 11, kINPT4 = 12, kINPT5 = 13;

Properties in_port(Controller left, Controller right = Controller::kJoystick) {
  Properties properties = ntsc();
  properties.left = left;
  properties.right = right;
  return properties;
}

struct Connected : Bench {
  explicit Connected(Controller left, Controller right = Controller::kJoystick)
      : Bench(Rom(4096, std::uint8_t{0xEA}), in_port(left, right)) {}

  // Inputs count from the beginning of a step on.
  void connect(const Inputs& inputs) {
    end_step();
    state.inputs = inputs;
  }
  bool high(unsigned pin, int cycle = 100) { return (read_at(cycle, pin) & 0x80) != 0; }
  unsigned left_nibble(int cycle = 100) { return read_at(cycle, kSWCHA) >> 4; }
  unsigned right_nibble(int cycle = 100) { return read_at(cycle, kSWCHA) & 0xFU; }
};

Inputs axes(Axis x, Axis y = {}) {
  Inputs inputs;
  inputs.paddle[0] = inputs.paddle[2] = x.packed();
  inputs.paddle[1] = inputs.paddle[3] = y.packed();
  return inputs;
}

TEST_CASE("A place and a way of an axis are what was packed") {
  for (const std::int32_t place : {0, 1, 80, 65535})
    for (const std::int32_t moved : {-16383, -127, -1, 0, 1, 127, 16383}) {
      const Axis axis = Axis::of(Axis{place, moved}.packed());
      CHECK(axis.place == place);
      CHECK(axis.moved == moved);
      CHECK(Axis{place, moved}.packed() >= 0);
    }
}

TEST_CASE("A keyboard: a column is low where the program drives a row of a pressed key low") {
  constexpr unsigned kColumns[2][3] = {{kINPT0, kINPT1, kINPT4}, {kINPT2, kINPT3, kINPT5}};
  for (const unsigned side : {0U, 1U})
    for (unsigned key = 0; key < 12; ++key) {
      Connected bench(Controller::kKeyboard, Controller::kKeyboard);
      Inputs inputs;
      inputs.paddle[2 * side] = 1 << key;
      bench.connect(inputs);
      bench.write_at(10, kSWACNT, 0xFF);
      for (unsigned row = 0; row < 4; ++row) {
        const unsigned levels = 0xFF ^ (1U << row) << (side == 0 ? 4 : 0);
        bench.write_at(20, kSWCHA, levels);
        CHECK(unsigned{bench.read_at(21, kSWCHA)} == levels);
        for (unsigned column = 0; column < 3; ++column) {
          INFO("side " << side << ", key " << key << ", row " << row << ", column " << column);
          CHECK(bench.high(kColumns[side][column]) == (key != 3 * row + column));
          CHECK(bench.high(kColumns[1 - side][column]));
        }
      }
    }
}

TEST_CASE("A keyboard: a row that is an input is not looked at, and VBLANK grounds two columns") {
  Connected bench(Controller::kKeyboard);
  Inputs inputs;
  inputs.paddle[0] = 0xFFF;
  bench.connect(inputs);
  bench.write_at(10, kSWCHA, 0x00);
  CHECK(bench.left_nibble() == 0xF);
  CHECK(bench.high(kINPT0));
  CHECK(bench.high(kINPT4));
  bench.write_at(20, kVBLANK, 0x80);
  CHECK_FALSE(bench.high(kINPT0));
  CHECK(bench.high(kINPT4));
}

TEST_CASE("Without a keyboard, the output register of SWCHA has no effect and is not kept") {
  Connected bench(Controller::kJoystick);
  bench.write_at(10, kSWACNT, 0xFF);
  bench.write_at(20, kSWCHA, 0x00);
  CHECK(unsigned{bench.read_at(21, kSWCHA)} == 0xFF);
  CHECK(unsigned{bench.state.frame.swcha} == 0);
}

TEST_CASE("A driving controller shows four codes in a row, and turns evenly in a frame") {
  constexpr unsigned kCodes[] = {3, 2, 0, 1};
  for (std::int32_t place = 0; place < 8; ++place) {
    Connected bench(Controller::kDriving, Controller::kDriving);
    bench.connect(axes({place, 0}));
    CHECK(bench.left_nibble() == (0xC | kCodes[place % 4]));
    CHECK(bench.right_nibble() == (0xC | kCodes[place % 4]));
  }
  for (const std::int32_t moved : {1, -1}) {
    Connected bench(Controller::kDriving);
    bench.connect(axes({4, moved}));
    CHECK(bench.left_nibble(100) == (0xC | kCodes[0]));
    CHECK(bench.left_nibble(19912) == (0xC | kCodes[(4 + moved) % 4]));
  }
}

TEST_CASE("A booster grip pulls INPT0 and INPT1 up, and is a joystick besides") {
  Connected bench(Controller::kBooster, Controller::kBooster);
  for (unsigned buttons = 0; buttons < 4; ++buttons) {
    Inputs inputs;
    const unsigned bits =
        kStickUp | kStickFire | (buttons & 1 ? kStickSecond : 0) | (buttons & 2 ? kStickThird : 0);
    inputs.joystick = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits)};
    bench.connect(inputs);
    CHECK(bench.high(kINPT0) == ((buttons & 1) != 0));
    CHECK(bench.high(kINPT1) == ((buttons & 2) != 0));
    CHECK(bench.high(kINPT2) == ((buttons & 1) != 0));
    CHECK(bench.high(kINPT3) == ((buttons & 2) != 0));
    CHECK_FALSE(bench.high(kINPT4));
    CHECK(bench.left_nibble() == 0xE);
  }
}

TEST_CASE("A Genesis pad's C pulls INPT1 down, or INPT3") {
  for (const bool pressed : {false, true}) {
    Connected bench(Controller::kGenesis, Controller::kGenesis);
    Inputs inputs;
    inputs.joystick = {static_cast<std::uint8_t>(pressed ? kStickSecond : 0), kStickFire};
    bench.connect(inputs);
    CHECK(bench.high(kINPT0));
    CHECK(bench.high(kINPT1) != pressed);
    CHECK(bench.high(kINPT3));
    CHECK(bench.high(kINPT4));
    CHECK_FALSE(bench.high(kINPT5));
    bench.write_at(20, kVBLANK, 0x80);
    CHECK_FALSE(bench.high(kINPT0));
  }
}

TEST_CASE("A light gun pulls INPT4 down for 16 cycles of five lines, and its trigger opens a switch") {
  for (const bool right : {false, true}) {
    Connected bench(right ? Controller::kJoystick : Controller::kLightGun,
                    right ? Controller::kLightGun : Controller::kJoystick);
    bench.connect(axes({80, 0}, {100, 0}));
    const int passes = 76 * (34 + 100) + (68 + 80) / 3;
    std::vector<int> first;
    bool before = true;
    int low = 0;
    for (int cycle = 0; cycle < 19912; ++cycle) {
      const bool high = bench.high(right ? kINPT5 : kINPT4, cycle);
      if (before && !high) first.push_back(cycle - passes);
      low += high ? 0 : 1;
      before = high;
    }
    CHECK(first == std::vector<int>{-152, -76, 0, 76, 152});
    CHECK(low == 5 * 16);
    CHECK(bench.high(right ? kINPT4 : kINPT5));
    CHECK((right ? bench.right_nibble() : bench.left_nibble()) == 0xE);
    bench.state.inputs.joystick = {kStickFire, kStickFire};
    CHECK((right ? bench.right_nibble() : bench.left_nibble()) == 0xF);
  }
}

TEST_CASE("A trackball shows the direction and the motion of both axes") {
  for (const std::int32_t x : {-40, 0, 40})
    for (const std::int32_t y : {-30, 30}) {
      Connected bench(Controller::kTrackball);
      bench.connect(axes({1000, x}, {1000, y}));
      int changes[4] = {};
      unsigned before = bench.left_nibble(0);
      for (int cycle = 1; cycle <= 19912; ++cycle) {
        const unsigned now = bench.left_nibble(cycle);
        for (unsigned pin = 0; pin < 4; ++pin) changes[pin] += ((before ^ now) >> pin & 1) != 0;
        before = now;
      }
      CHECK(changes[0] == 0);
      CHECK(changes[1] == std::abs(x));
      CHECK(changes[3] == std::abs(y));
      CHECK((before & 1) == (x >= 0 ? 1 : 0));
      CHECK((before >> 2 & 1) == (y >= 0 ? 1 : 0));
    }
}

TEST_CASE("A mouse has two signals for each axis, a quarter of a period apart") {
  struct {
    Controller controller;
    unsigned x_a, x_b, y_a, y_b;  // pins
  } const kMice[] = {{Controller::kAtariMouse, 2, 1, 3, 4}, {Controller::kAmigaMouse, 2, 4, 1, 3}};
  for (const auto& mouse : kMice)
    for (std::int32_t place = 0; place < 8; ++place) {
      Connected bench(mouse.controller);
      bench.connect(axes({place, 0}, {place + 1, 0}));
      const auto pin = [&](unsigned number) { return bench.left_nibble() >> (number - 1) & 1; };
      const auto x = static_cast<unsigned>(place), y = x + 1;
      CHECK(pin(mouse.x_a) == (x >> 1 & 1));
      CHECK(pin(mouse.x_b) == ((x + 1) >> 1 & 1));
      CHECK(pin(mouse.y_a) == (y >> 1 & 1));
      CHECK(pin(mouse.y_b) == ((y + 1) >> 1 & 1));
    }
}

TEST_CASE("Two controllers have axes of their own, which go with swapped ports") {
  const Inputs one = axes({1, 16383}, {2, -16383}), other = axes({2, -16383}, {1, 16383});
  Inputs both;
  both.paddle = {one.paddle[0], one.paddle[1], other.paddle[0], other.paddle[1]};
  for (const Controller controller :
       {Controller::kDriving, Controller::kTrackball, Controller::kAtariMouse, Controller::kAmigaMouse}) {
    const auto shows = [controller](const Inputs& inputs) {
      Connected bench(controller);
      bench.connect(inputs);
      return bench.left_nibble();
    };
    REQUIRE(shows(one) != shows(other));
    for (const bool swapped : {false, true}) {
      Properties properties = in_port(controller, controller);
      properties.swap_ports = swapped;
      Bench bench(Rom(4096, std::uint8_t{0xEA}), properties);
      bench.state.inputs = both;
      const unsigned left = shows(swapped ? other : one), right = shows(swapped ? one : other);
      INFO(static_cast<int>(controller));
      CHECK(unsigned{bench.read_at(100, kSWCHA)} == (left << 4 | right));
    }
  }
}

TEST_CASE("Two light guns see the beam at places of their own") {
  Connected bench(Controller::kLightGun, Controller::kLightGun);
  Inputs inputs;
  inputs.paddle = {Axis{0, 0}.packed(), Axis{50, 0}.packed(), Axis{159, 0}.packed(), Axis{150, 0}.packed()};
  bench.connect(inputs);
  const int left = 76 * (34 + 50) + 68 / 3, right = 76 * (34 + 150) + (68 + 159) / 3;
  CHECK_FALSE(bench.high(kINPT4, left));
  CHECK(bench.high(kINPT5, left));
  CHECK(bench.high(kINPT4, right));
  CHECK_FALSE(bench.high(kINPT5, right));
  CHECK(bench.high(kINPT5, right - 1));
}

TEST_CASE("VBLANK grounds the pins that a booster grip pulls up") {
  Connected bench(Controller::kBooster);
  Inputs inputs;
  inputs.joystick = {kStickSecond | kStickThird, 0};
  bench.connect(inputs);
  CHECK((bench.high(kINPT0) && bench.high(kINPT1)));
  bench.write_at(120, kVBLANK, 0x80);
  CHECK_FALSE(bench.high(kINPT0, 130));
  CHECK_FALSE(bench.high(kINPT1, 130));
}

TEST_CASE("Nothing answers where no controller is") {
  Connected bench(Controller::kNone, Controller::kNone);
  Inputs inputs;
  inputs.joystick = {kStickBits, kStickBits};
  bench.connect(inputs);
  CHECK(unsigned{bench.read_at(100, kSWCHA)} == 0xFF);
  CHECK(bench.high(kINPT4));
  CHECK(bench.high(kINPT5));
  CHECK_FALSE(bench.high(kINPT0));
}

}  // namespace
}  // namespace racebeam::test

// The console as a whole: state, formats, resets, controllers (docs/spec/console.md).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/support/crc.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::shared_ptr<const Rom> image(const Bytes& program) {
  auto rom = std::make_shared<Rom>(4096, std::uint8_t{0xEA});
  std::copy(program.begin(), program.end(), rom->begin());
  (*rom)[0xFFC] = 0x00;
  (*rom)[0xFFD] = 0xF0;
  return rom;
}

struct Machine {
  explicit Machine(const Bytes& program, const Properties& properties = ntsc())
      : console(image(program), properties, generator) {}
  SystemGenerator generator{4753849};
  Console console;

  std::uint32_t digest() const { return crc(console.picture()) ^ crc(console.ram()); }
};

// A picture that changes with every line and frame, in frames of 4 + 2n lines, and one more with `extra`.
Bytes frames_of(std::uint8_t n, bool extra = false) {
  const std::uint8_t wsync_or_cxclr = extra ? 0x02 : 0x2C;
  return {0xA9, 0x02, 0x85, 0x00,
          0x85, 0x02, 0x85, 0x02,
          0x85, 0x02, 0xA9, 0x00,
          0x85, 0x00,  // VSYNC, 3 WSYNC
          0xE6, 0x80, 0xA2, 0xFF,
          0x86, 0x1B, 0x86, 0x0E,
          0x85, 0x10,                        // GRP0, PF1, RESP0
          0x85, 0x02, 0x85, wsync_or_cxclr,  //
          0xA0, 0x02, 0xA2, n,               // twice n lines:
          0x85, 0x02, 0x8A, 0x65,
          0x80, 0x85, 0x09, 0x85,
          0x0F, 0x85, 0x06,  // COLUBK, PF2, COLUP0
          0xCA, 0xD0, 0xF2, 0x88,
          0xD0, 0xED, 0x4C, 0x00,
          0xF0};
}

TEST_CASE("The machine is one plain value of at most 2 KiB") {
  STATIC_REQUIRE(sizeof(State) <= 2048);
  STATIC_REQUIRE(std::is_trivially_copyable_v<State>);
  STATIC_REQUIRE(std::has_unique_object_representations_v<State>);
}

// RAM[$FF] = n; the frame is closed by JSR $000E, whose return address goes into VSYNC.
Bytes fetches_what_the_bus_holds(std::uint8_t n) {
  return {0xA9, n,    0x85, 0xFF, 0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85,
          0x02, 0x85, 0x02, 0xA2, 0x01, 0x9A, 0xEA, 0xEA, 0x20, 0x0E, 0x00};
}

void wait(Bytes& program, unsigned cycles) {
  if (cycles % 2 == 1) program.insert(program.end(), {0x04, 0x80});
  program.insert(program.end(), (cycles - 3 * (cycles % 2)) / 2, 0xEA);
}

// Runs `STA PF1` from the last bytes of RAM, `delay` cycles after CXCLR. PF1 has this value already, so that
// the write only ends a span of drawing. The next opcode is the register of missile 0's collisions: RTI if it
// has met player 0 by then, else BRK. One of them leads to JAM, the other draws on. Both objects are at
// `place`.
Bytes fetches_collisions(unsigned place, unsigned delay, bool jams_if_met) {
  Bytes program = {0xA9, 0x85, 0x85, 0xFE, 0xA9, 0x0E, 0x85, 0xFF,  // STA PF1 at $FE
                   0x85, 0x09, 0x85, 0x1D,                          // COLUBK, ENAM0
                   0xA9, 0xF1, 0x85, 0xFC, 0xA9, 0x80, 0x85, 0xFB,  // what RTI pulls: $F180
                   0xA2, 0xF9, 0x9A, 0xA9, 0x37, 0x85, 0x04,        // NUSIZ0
                   0xA9, 0xFF, 0x85, 0x1B, 0xA9, 0xC0, 0x85, 0x0E,  // GRP0, PF1
                   0xA0, 0x40, 0x85, 0x02, 0x88, 0xD0, 0xFB};       // 64 lines
  wait(program, place);
  program.insert(program.end(),
                 {0x85, 0x10, 0x85, 0x12, 0x85, 0x02, 0x85, 0x2C});  // RESP0, RESM0, WSYNC, CXCLR
  wait(program, delay);
  program.insert(program.end(), {0x4C, 0xFE, 0x00});
  program.resize(0x1000, 0xEA);
  const Bytes draws_on = {0x85, 0x02, 0x4C, 0x80, 0xF1};
  const int jam = jams_if_met ? 0x180 : 0x190, other = 0x310 - jam;
  std::ranges::copy(draws_on, program.begin() + other);
  program[other + 3] = static_cast<std::uint8_t>(other);
  program[jam] = 0x12;
  program[0xFFE] = 0x90;  // what BRK jumps to: $F190
  program[0xFFF] = 0xF1;
  return program;
}

TEST_CASE("A frame that jams where collisions are fetched as code shows nothing after the beam") {
  int jammed = 0, drew_on = 0;
  for (unsigned place = 2; place < 6; ++place) {
    for (unsigned delay = 2; delay < 60; ++delay) {
      CAPTURE(place, delay);
      Machine machine(fetches_collisions(place, delay, true));
      machine.console.reset();
      machine.console.step();
      const State& state = machine.console.state();
      (state.cpu.jammed ? jammed : drew_on) += 1;
      if (!state.cpu.jammed) continue;
      const std::ptrdiff_t rows = (3 * state.cycle - state.tia.origin) / 228 + 1;
      const auto after = machine.console.picture().subspan(160 * rows);
      REQUIRE(std::ranges::count(after, 0) == std::ssize(after));
    }
  }
  REQUIRE(jammed > 0);
  REQUIRE(drew_on > 0);
}

TEST_CASE(
    "Reads and writes of RAM from outside leave the byte on the bus, from which an opcode may be fetched") {
  constexpr std::uint8_t kJam = 0x12, kRolA = 0x2A;
  Machine looked_at(fetches_what_the_bus_holds(kJam)), written(fetches_what_the_bus_holds(kRolA));
  for (Machine* machine : {&looked_at, &written}) {
    machine->console.step();
    REQUIRE(machine->console.state().cpu.PC == 0x000E);
  }
  looked_at.console.read_ram(127);
  written.console.set_ram(0, kJam);
  for (Machine* machine : {&looked_at, &written}) {
    machine->console.step();
    CHECK(machine->console.state().cpu.jammed == 1);
    CHECK(machine->console.state().cpu.PC == 0x000F);
  }
}

TEST_CASE("A restored machine goes on as the saved one did") {
  Machine machine(frames_of(129));
  for (int i = 0; i < 7; ++i) machine.console.step();
  const State saved = machine.console.state();
  const FrameBuffers pictures = machine.console.pictures();
  const Bytes current(machine.console.picture().begin(), machine.console.picture().end());
  const Bytes previous(machine.console.previous_picture().begin(), machine.console.previous_picture().end());
  std::vector<std::uint32_t> first, second;
  for (int i = 0; i < 9; ++i) {
    machine.console.step();
    first.push_back(machine.digest());
  }
  CHECK(first[0] != first[1]);
  CHECK(std::equal(current.begin(), current.end(), pictures.current->pixels().begin()));  // not overwritten

  machine.console.restore(saved);
  CHECK(std::memcmp(&saved, &machine.console.state(), sizeof saved) == 0);
  for (int i = 0; i < 9; ++i) {
    machine.console.step();
    second.push_back(machine.digest());
  }
  CHECK(first == second);

  Machine other(frames_of(129));
  other.console.restore(saved);
  other.console.restore_pictures(pictures);
  CHECK(std::equal(current.begin(), current.end(), other.console.picture().begin()));
  CHECK(std::equal(previous.begin(), previous.end(), other.console.previous_picture().begin()));
  for (int i = 0; i < 9; ++i) {
    other.console.step();
    CHECK(other.digest() == first[static_cast<std::size_t>(i)]);
  }
  CHECK(std::memcmp(&machine.console.state(), &other.console.state(), sizeof saved) == 0);
}

TEST_CASE("Equal histories are equal values, and a reset is part of the history") {
  Machine one(frames_of(129)), two(frames_of(129));
  for (int i = 0; i < 3; ++i) {
    one.console.step();
    two.console.step();
  }
  CHECK(std::memcmp(&one.console.state(), &two.console.state(), sizeof(State)) == 0);
  one.console.reset();
  CHECK(std::memcmp(&one.console.state(), &two.console.state(), sizeof(State)) != 0);
  two.console.reset();
  CHECK(std::memcmp(&one.console.state(), &two.console.state(), sizeof(State)) == 0);
}

TEST_CASE("Long frames make a PAL console, short ones an NTSC one") {
  struct Case {
    std::uint8_t n;
    bool extra;
    int lines;
    Format format;
    int height;
  };
  constexpr Case kCases[] = {{129, false, 262, Format::kNtsc, 210},
                             {154, false, 312, Format::kPal, 250},
                             {140, true, 285, Format::kNtsc, 210},
                             {141, false, 286, Format::kPal, 250}};
  for (const Case& c : kCases) {
    INFO(c.lines << " lines");
    Properties detected = ntsc();
    detected.format = Format::kAuto;
    Machine machine(frames_of(c.n, c.extra), detected);
    CHECK(machine.console.format() == c.format);
    CHECK(machine.console.height() == c.height);
    CHECK(machine.console.state().drawn == 128 + 1 + 1 + 1);  // RAM, and the timer three times
    machine.console.step();
    machine.console.step();
    CHECK(machine.console.state().frame.lines == c.lines);
  }
}

TEST_CASE("A format from the properties takes no detection run") {
  Properties pal60 = ntsc();
  pal60.format = Format::kPal60;
  Machine machine(frames_of(129), pal60);
  CHECK(machine.console.height() == 210);
  CHECK(machine.console.state().drawn == 128 + 1 + 1);
  CHECK(machine.console.state().cycle == 0);
}

TEST_CASE("A picture lower than 200 lines is filled up with black") {
  Properties low = ntsc();
  low.height = 150;
  Machine machine(frames_of(129), low);
  for (int i = 0; i < 4; ++i) machine.console.step();
  CHECK(machine.console.height() == 200);
  const auto rows = machine.console.picture();
  CHECK(std::ranges::any_of(rows.subspan(149 * 160, 160), [](std::uint8_t v) { return v != 0; }));
  CHECK(std::ranges::all_of(rows.subspan(150 * 160), [](std::uint8_t v) { return v == 0; }));
}

// docs/spec/console.md, "More cases".

TEST_CASE("Case 2: with swapped ports player A drives the right one") {
  Properties swapped = ntsc();
  swapped.swap_ports = true;
  Bench bench(Rom(4096, 0xEA), swapped);
  bench.state.inputs.joystick[0] = kStickUp | kStickFire;
  CHECK(int{bench.read_at(10, 0x280)} == 0xFE);
  CHECK((bench.read_at(10, 12) & 0x80) == 0x80);
  CHECK((bench.read_at(10, 13) & 0x80) == 0x00);
}

TEST_CASE("Case 3: the buttons of paddles, swapped or not") {
  struct Case {
    bool swap;
    std::uint8_t fire;
    int swcha;
  };
  for (const Case& c : {Case{false, 1, 0x7F}, {false, 2, 0xBF}, {true, 1, 0xBF}, {true, 2, 0x7F}}) {
    Properties paddles = ntsc();
    paddles.left = Controller::kPaddles;
    paddles.swap_paddles = c.swap;
    Bench bench(Rom(4096, 0xEA), paddles);
    bench.state.inputs.paddle_fire = c.fire;
    CHECK(int{bench.read_at(10, 0x280)} == c.swcha);
    CHECK((bench.read_at(10, 12) & 0x80) == 0x80);
  }
}

TEST_CASE("Paddles of the right port, and a pot of no resistance") {
  Properties paddles = ntsc();
  paddles.right = Controller::kPaddles;
  Bench bench(Rom(4096, 0xEA), paddles);
  bench.state.inputs.paddle_fire = 4;
  CHECK(int{bench.read_at(10, 0x280)} == 0xF7);
  bench.state.inputs.paddle_fire = 8;
  CHECK(int{bench.read_at(10, 0x280)} == 0xFB);
  bench.state.inputs.paddle = {0, 0, 0, 27450};
  bench.write_at(0, VBLANK, 0x80);
  CHECK((bench.read_at(3, 8) & 0x80) == 0x00);   // left: a joystick has no pots
  CHECK((bench.read_at(3, 10) & 0x80) == 0x80);  // no resistance: charged even while it is discharged
  CHECK((bench.read_at(3, 11) & 0x80) == 0x00);
  bench.write_at(100, VBLANK, 0x00);
  CHECK((bench.read_at(622, 11) & 0x80) == 0x00);  // 522 cycles
  CHECK((bench.read_at(623, 11) & 0x80) == 0x80);
}

TEST_CASE("Each pot charges its own pin, also if ports or paddles are swapped") {
  const bool swap_ports = GENERATE(false, true), swap_paddles = GENERATE(false, true);
  Properties paddles = ntsc();
  paddles.left = paddles.right = Controller::kPaddles;
  paddles.swap_ports = swap_ports;
  paddles.swap_paddles = swap_paddles;
  Bench bench(Rom(4096, 0xEA), paddles);
  bench.state.inputs.paddle = {10000, 20000, 30000, 40000};
  bench.write_at(0, VBLANK, 0x80);
  bench.write_at(100, VBLANK, 0x00);
  for (unsigned paddle = 0; paddle < 4; ++paddle) {
    const unsigned pin = 8 + (paddle ^ (swap_ports ? 2U : 0U) ^ (swap_paddles ? 1U : 0U));
    const int need = static_cast<int>(1.6 * 10000 * (paddle + 1) * 0.01e-6 * 1.19e6);
    INFO("paddle " << paddle << ", INPT" << pin - 8);
    CHECK((bench.read_at(100 + need, pin) & 0x80) == 0x00);
    CHECK((bench.read_at(101 + need, pin) & 0x80) == 0x80);
  }
}

// COLUBK = $2E; frames of 254 lines; in the fourth, the processor jams after 100 lines.
const Bytes kJams = {0xA9, 0x2E, 0x85, 0x09, 0xA9, 0x00, 0x85, 0x80,  // once
                     0xA9, 0x02, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0x85, 0x02,
                     0xA9, 0x00, 0x85, 0x00,                                       // VSYNC
                     0xA2, 0x64, 0x85, 0x02, 0xCA, 0xD0, 0xFB,                     // 100 lines
                     0xE6, 0x80, 0xA5, 0x80, 0xC9, 0x04, 0xD0, 0x01, 0x02,         // JAM
                     0xA2, 0x96, 0x85, 0x02, 0xCA, 0xD0, 0xFB, 0x4C, 0x08, 0xF0};  // 150 lines

void check_greyed(const Console& console) {
  for (int row = 0; row < 210; ++row) {
    INFO("row " << row);
    const auto pixels = console.picture().subspan(static_cast<std::size_t>(row) * 160, 160);
    REQUIRE(std::ranges::all_of(pixels, [row](std::uint8_t v) { return v == (row < 66 ? 0x2E : 0x07); }));
  }
}

TEST_CASE("Case 5: a processor that jams leaves the rest of the picture grey, until a reset") {
  Machine machine(kJams);
  Console& console = machine.console;
  while (!console.state().cpu.jammed) console.step();
  CHECK(console.state().frame.open == 1);
  CHECK(console.state().cycle / 76 == 100);
  check_greyed(console);
  const State jammed = console.state();
  for (int i = 0; i < 3; ++i) {
    console.step();
    check_greyed(console);
    CHECK(std::memcmp(&jammed, &console.state(), sizeof jammed) == 0);
  }
  console.reset();
  CHECK(std::ranges::all_of(console.picture(), [](std::uint8_t v) { return v == 0; }));
  console.step();
  CHECK(console.state().frame.open == 0);
}

// RAM survives a reset: the first run jams at once, the second shows a colour that counts lines.
const Bytes kCountsLines = {
    0xA5, 0x80, 0xC9, 0x5A, 0xF0, 0x05, 0xA9, 0x5A, 0x85, 0x80, 0x02,  // first time: JAM
    0xA2, 0x00, 0x85, 0x02, 0x86, 0x09, 0xE8, 0x4C, 0x0D, 0xF0};       // WSYNC; STX COLUBK; INX

std::vector<int> first_pixels(const Console& console, std::initializer_list<int> rows) {
  std::vector<int> colors;
  for (const int row : rows) colors.push_back(console.picture()[static_cast<std::size_t>(row) * 160]);
  return colors;
}

TEST_CASE(
    "After a reset in an open frame the picture is drawn from line 0 on, 34 rows lower than it should be") {
  Machine machine(kCountsLines);
  machine.console.step();
  CHECK(machine.console.state().frame.open == 1);
  machine.console.reset();
  CHECK(machine.console.state().frame.open == 1);
  machine.console.step();
  CHECK(machine.console.state().frame.open == 0);
  // Nothing is drawn before line 34; then all writes up to there have taken effect.
  CHECK(first_pixels(machine.console, {0, 1, 33, 51, 101, 209}) == std::vector{32, 32, 32, 50, 100, 208});

  Machine fresh(kCountsLines);
  fresh.console.set_ram(0, 0x5A);
  fresh.console.step();
  CHECK(fresh.console.state().frame.lines == 291);
  CHECK(first_pixels(fresh.console, {1, 51, 101, 209}) == std::vector{34, 84, 134, 242});
}

TEST_CASE("The instruction limit ends a step without closing the frame") {
  Machine machine({0xEA, 0x4C, 0x00, 0xF0});  // NOP; JMP: no TIA write, ever
  machine.console.step();
  CHECK(machine.console.state().frame.open == 1);
  CHECK(machine.console.state().cycle == 12500 * 5);
  machine.console.step();
  CHECK(machine.console.state().cycle == 2 * 12500 * 5);
}

}  // namespace
}  // namespace racebeam::test

// The cases of docs/spec/tia.md, "How to check", by number.
#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

constexpr unsigned kCXCLR = CXCLR, kCXBLPF = 6, kINPT0 = 8;

std::string hex(unsigned value) {
  const char* digits = "0123456789ABCDEF";
  return {digits[value >> 4 & 15], digits[value & 15]};
}

// The pixels of a row that are not 0E, in the notation of the specification: "0-3:56 7:78".
std::string runs(std::span<const std::uint8_t> row) {
  std::string text;
  for (std::size_t i = 0; i < row.size();) {
    std::size_t end = i;
    while (end < row.size() && row[end] == row[i]) ++end;
    if (row[i] != 0x0E) {
      std::ostringstream run;
      run << (text.empty() ? "" : " ") << i;
      if (end - i > 1) run << "-" << end - 1;
      run << ":" << hex(row[i]);
      text += run.str();
    }
    i = end;
  }
  return text;
}

struct Write {
  int line, x;
  unsigned reg, value;
};

// S0, then these writes.
Bench begun(std::initializer_list<Write> writes) {
  Bench bench;
  for (const auto& [reg, x, value] :
       {std::tuple{COLUBK, 10, 0x0E}, {COLUPF, 13, 0x34}, {COLUP0, 16, 0x56}, {COLUP1, 19, 0x78}})
    bench.write(0, x, reg, static_cast<unsigned>(value));
  for (const Write& w : writes) bench.write(w.line, w.x, w.reg, w.value);
  return bench;
}

// The same, and everything is drawn.
Bench played(std::initializer_list<Write> writes) {
  Bench bench = begun(writes);
  bench.write(250, 0, VSYNC, 0);
  bench.end_step();
  return bench;
}

struct Row {
  int number;
  std::string expected;
};

void check_rows(Bench bench, std::initializer_list<Row> rows) {
  for (const Row& row : rows) {
    INFO("row " << row.number);
    CHECK(runs(bench.row(row.number)) == row.expected);
  }
}

TEST_CASE("Case 1: score mode colours a lone playfield even under priority") {
  check_rows(played({{0, 22, CTRLPF, 0x06}, {0, 25, PF0, 0x10}, {36, 0, GRP1, 0x01}, {40, 0, CTRLPF, 0x02}}),
             {{0, "0-3:56 80-83:78"}, {3, "0-3:34 7:78 80-83:34"}, {7, "0-3:56 7:78 80-83:78"}});
}

TEST_CASE("Case 2: a playfield write acts from the next block of four pixels on") {
  const std::pair<int, std::string> cases[] = {{24, ""},         {25, ""},         {26, ""},
                                               {27, ""},         {28, "16-19:34"}, {29, "16-23:34"},
                                               {30, "16-23:34"}, {31, "16-27:34"}};
  for (const auto& [x, expected] : cases) {
    INFO("x = " << x);
    check_rows(played({{50, 0, PF1, 0xFF}, {50, x, PF1, 0x00}}), {{16, expected}});
  }
}

TEST_CASE("Case 3: a player that is placed anew is left out for a line, unless its start is met") {
  check_rows(played({{1, 0, GRP0, 0xFF},
                     {40, 23, RESP0, 0},
                     {41, 30, RESP0, 0},
                     {50, 10, RESP0, 0},
                     {60, 22, RESP0, 0}}),
             {{6, "0-7:56"},
              {7, "6-13:56"},
              {8, "27-34:56"},
              {15, "27-34:56"},
              {16, ""},
              {17, "3-10:56"},
              {26, "3-10:56"}});
}

TEST_CASE("Case 4: an HMOVE in vertical blank blanks the start of row 0") {
  check_rows(played({{10, 3, HMOVE, 0}}), {{0, "0-7:00"}, {1, ""}});
}

TEST_CASE("Case 5: how far HMOVE moves depends on its cycle") {
  constexpr unsigned kMotions[] = {0x70, 0x60, 0x10, 0x00, 0xF0, 0x90, 0x80};
  struct Case {
    int x;
    int moved[7];
  };
  constexpr Case kCases[] = {{3, {-7, -6, -1, 0, 1, 7, 8}}, {8, {-3, -3, -1, 0, 1, 7, 8}},
                             {16, {3, 3, 3, 3, 3, 7, 8}},   {20, {6, 6, 6, 6, 6, 7, 8}},
                             {60, {-5, -4, 0, 0, 0, 0, 0}}, {73, {-15, -14, -9, -8, -7, -1, 0}}};
  for (const Case& c : kCases)
    for (std::size_t i = 0; i < 7; ++i) {
      INFO("x = " << c.x << ", HMBL = " << hex(kMotions[i]));
      const std::string expected = std::to_string(56 + c.moved[i]) + ":34";
      check_rows(
          played({{1, 0, ENABL, 2}, {1, 40, RESBL, 0}, {1, 43, HMBL, kMotions[i]}, {2, c.x, HMOVE, 0}}),
          {{1, expected}});
    }
}

TEST_CASE("Case 6: Cosmic Ark's stars") {
  check_rows(played({{1, 0, ENAM0, 2},
                     {33, 5, HMM0, 0x70},
                     {33, 60, RESM0, 0},
                     {34, 3, HMOVE, 0},
                     {34, 24, HMM0, 0x60}}),
             {{0, "0-7:00 109:56"},
              {1, "76-77:56"},
              {2, ""},
              {3, "59:56"},
              {4, "41:56"},
              {5, "8-9:56"},
              {6, ""},
              {7, "151:56"}});
}

TEST_CASE("Case 7: late in a line the playfield is turned round only from the next one on") {
  const std::string copied = "0-3:34 80-83:34", mirrored = "0-3:34 156-159:34";
  check_rows(
      played({{1, 0, PF0, 0x10}, {40, 48, CTRLPF, 1}, {42, 48, CTRLPF, 0}, {44, 50, CTRLPF, 1}}),
      {{6, mirrored}, {7, mirrored}, {8, copied}, {9, copied}, {10, copied}, {11, mirrored}, {12, mirrored}});
}

TEST_CASE("Case 8: a collision is seen once its pixel is drawn, and never under VBLANK") {
  Bench bench;
  for (const Write& w : {Write{1, 0, ENABL, 2}, {1, 3, CTRLPF, 0x30}, {1, 40, RESBL, 0}, {1, 43, PF2, 0xFF}})
    bench.write(w.line, w.x, w.reg, w.value);
  CHECK((bench.read(33, 75, kCXBLPF) & 0x80) == 0);
  CHECK((bench.read(34, 41, kCXBLPF) & 0x80) == 0);
  CHECK((bench.read(34, 42, kCXBLPF) & 0x80) == 0x80);
  bench.write(35, 0, kCXCLR, 0);
  bench.write(35, 3, VBLANK, 2);
  CHECK((bench.read(37, 0, kCXBLPF) & 0x80) == 0);
}

Bench paddles_released_at(int line) {
  Properties properties = ntsc();
  properties.left = Controller::kPaddles;
  Bench bench(Rom(4096, 0xEA), properties);
  bench.state.inputs.paddle[0] = 408823;
  bench.write(10, 0, VBLANK, 0x80);
  bench.write(line, 0, VBLANK, 0x00);
  return bench;
}

TEST_CASE(
    "Case 9: a paddle's capacitor is charged after a time, if it was let go in this frame or just before") {
  Bench same = paddles_released_at(20);
  CHECK((same.read_at(9303, kINPT0) & 0x80) == 0);
  CHECK((same.read_at(9304, kINPT0) & 0x80) == 0x80);
  same.next_frame(262 * kLineCycles);
  for (const int cycle : {0, 7782, 9304, 19000}) CHECK((same.read_at(cycle, kINPT0) & 0x80) == 0);

  Bench late = paddles_released_at(259);
  late.next_frame(262 * kLineCycles);
  CHECK((late.read_at(7555, kINPT0) & 0x80) == 0);
  CHECK((late.read_at(7556, kINPT0) & 0x80) == 0x80);
}

TEST_CASE("Case 10: without VSYNC a frame closes with the first write after line 290") {
  auto rom = std::make_shared<Rom>(4096, std::uint8_t{0xEA});
  const std::uint8_t program[] = {0x85, 0x02, 0xE6, 0x80, 0xA5, 0x80, 0x85, 0x09, 0x4C, 0x00, 0xF0};
  std::copy(std::begin(program), std::end(program), rom->begin());
  (*rom)[0xFFC] = 0x00;
  (*rom)[0xFFD] = 0xF0;
  SystemGenerator generator(4753849);
  Console console(rom, ntsc(), generator);
  console.step();
  for (int i = 0; i < 5; ++i) {
    console.step();
    CHECK(console.state().cycle == 22116);
    CHECK(console.state().frame.lines == 291);
  }
}

// The ball meets no playfield, so that each read of their latch draws up to its cycle.
Bench interrupted_on_line_60(bool goes_further) {
  Bench bench = begun({{0, 30, PF0, 0xF0}, {0, 33, ENABL, 2}, {1, 40, RESBL, 0}, {60, 30, COLUBK, 0x12}});
  bench.end_step();
  const State kept = bench.state;
  bench.read(60, 35, kCXBLPF);
  if (goes_further) bench.read(61, 60, kCXBLPF);
  bench.restore(kept);
  bench.write(60, 50, COLUBK, 0x9A);
  bench.write(250, 0, VSYNC, 0);
  bench.end_step();
  return bench;
}

TEST_CASE(
    "A state restored in the middle of a step goes on from its own clock, though the beam was further") {
  Bench expected = interrupted_on_line_60(false), further = interrupted_on_line_60(true);
  CHECK(expected.row(26)[100] == 0x9A);
  CHECK(std::ranges::equal(further.picture().pixels(), expected.picture().pixels()));
  CHECK(further.state.tia.pixel == expected.state.tia.pixel);
}

// Pixels that the reference writes ahead of the beam (section 6), in a frame that closes inside the window.

TEST_CASE("A picture that stops after a group of four has begun shows the whole group") {
  struct Case {
    std::initializer_list<Write> enable;
    int last_cycle;
    std::string expected;
  };
  const Case cases[] = {
      // Only the background: no groups. COLUBK at cycle 42: 126 - 68 = 58 pixels.
      {{}, 42, "58-159:00"},
      // A lone playfield is grouped; a CTRLPF write stops at pixel 58 and shows 60.
      {{{1, 0, PF0, 0x10}}, 42, "0-3:34 60-159:00"},
      // The ball's shape in the group prevents grouping; it is at 58.
      {{{1, 0, ENABL, 2}, {1, 21, RESBL, 0}}, 42, "2:34 60-159:00"},
      {{{1, 0, ENABL, 2}, {1, 41, RESBL, 0}}, 42, "58-159:00"},
      // Two objects that are not a pair of the list.
      {{{1, 0, ENABL, 2}, {1, 21, RESBL, 0}, {1, 30, GRP0, 1}}, 42, "2:34 7:56 58-159:00"},
      // Playfield and player, with and without score mode.
      {{{1, 0, PF0, 0x10}, {1, 30, GRP0, 1}}, 42, "0-3:34 7:56 60-159:00"},
      {{{1, 0, PF0, 0x10}, {1, 30, GRP0, 1}, {1, 40, CTRLPF, 2}}, 42, "0-3:56 7:56 58-159:00"},
  };
  for (const Case& c : cases) {
    INFO(c.expected);
    Bench bench;
    for (const auto& [reg, value] : {std::pair{COLUBK, 0x0E}, {COLUPF, 0x34}, {COLUP0, 0x56}, {COLUP1, 0x78}})
      bench.write(0, static_cast<int>(reg), reg, static_cast<unsigned>(value));
    for (const Write& w : c.enable) bench.write(w.line, w.x, w.reg, w.value);
    bench.write(34, c.last_cycle, VSYNC, 0);
    bench.end_step();
    CHECK(runs(bench.row(0)) == c.expected);
  }
}

}  // namespace
}  // namespace racebeam::test

// Lines that show what they showed in the frame before are not drawn again, although their writes or
// registers differ where that is not seen.
#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "tests/emulator/comparison.hpp"

namespace racebeam::test {
namespace {

constexpr int kFirstRow = 3, kRows = 8;
constexpr int kFrameCycles = (kFirstRow + kRows + 2) * kLineCycles;
constexpr int kAll = kRows - 1;  // the last row is never remembered

// The accesses of a frame, by its number.
using Frame = std::function<Script(int)>;

Access write(int line, int cycle, unsigned reg, unsigned value) {
  return {Access::kWrite, line * kLineCycles + cycle, reg, value};
}

// Adds this write in this cycle of each row.
void on_each_row(Script& script, int cycle, unsigned reg, unsigned value) {
  for (int row = 0; row < kRows; ++row) script.push_back(write(kFirstRow + row, cycle, reg, value));
}

Script in_order(Script script) {
  std::ranges::stable_sort(script, {}, &Access::cycle);
  return script;
}

Properties window() {
  Properties properties = ntsc();
  properties.ystart = kFirstRow;
  properties.height = kRows;
  return properties;
}

// Plays some frames, and compares each with the model. Returns how many rows were not drawn again in the
// last.
int rows_that_recur(const Frame& frame) {
  constexpr int kFrames = 9;
  Comparison machines(window(), false);
  Bench bench(Rom(4096, 0xEA), window());
  for (int number = 0; number < kFrames; ++number) {
    const Script script = in_order(frame(number));
    machines.play(script, kFrameCycles);
    machines.next_frame(kFrameCycles + kLineCycles);
    if (number > 0) bench.next_frame(kFrameCycles + kLineCycles);
    for (const Access& access : script) bench.store_at(access.cycle, access.reg, access.value);
    bench.write_at(kFrameCycles, 0x3F, 0);  // draws the picture to its end
    bench.end_step();
  }
  int rows = 0;
  for (std::size_t row = 0; row + 1 < kRows; ++row)
    rows += bench.pictures()[0].shows(row) == bench.pictures()[1].shows(row) ? 1 : 0;
  return rows;
}

TEST_CASE("What a strobe writes does not matter") {
  for (const unsigned reg : {RESP0, RESP1, RESM0, RESM1, RESBL, HMOVE, HMCLR, CXCLR}) {
    INFO("register " << reg);
    const int rows = rows_that_recur([reg](int number) {
      Script script;
      on_each_row(script, 30, reg, static_cast<unsigned>(number * 37) & 0xFF);
      return script;
    });
    CHECK(rows == kAll);
  }
}

TEST_CASE("Bits that a register does not keep do not matter, and the others do") {
  const auto rows = [](unsigned reg, unsigned varied) {
    return rows_that_recur([=](int number) {
      Script script = {write(0, 3, COLUPF, 0x2E), write(0, 9, COLUBK, 0x80), write(0, 40, RESBL, 0)};
      on_each_row(script, 3, reg, 0);
      on_each_row(script, 12, reg, 2U | (number % 2 != 0 ? varied : 0U));
      return script;
    });
  };
  CHECK(rows(ENABL, 0xFD) == kAll);
  CHECK(rows(ENABL, 0x02) == kAll);
  CHECK(rows(COLUPF, 0x01) == kAll);
  CHECK(rows(COLUBK, 0x01) == kAll);
  CHECK(rows(COLUBK, 0x10) == 0);
  CHECK(rows(PF1, 0x01) == 0);
}

TEST_CASE("Bits of CTRLPF matter where they show something") {
  const auto rows = [](unsigned shown, unsigned varied) {
    return rows_that_recur([=](int number) {
      return Script{write(0, 3, COLUPF, 0x2E),
                    write(0, 9, COLUBK, 0x80),
                    write(0, 15, shown, 0x1A),
                    write(0, 21, GRP0, shown == ENABL ? 0xFF : 0),
                    write(0, 40, RESP0, 0),
                    write(0, 43, RESBL, 0),
                    write(1, 9, CTRLPF, number % 2 != 0 ? varied : 0U)};
    });
  };
  CHECK(rows(PF1, 0x30) == kAll);  // the ball's width
  CHECK(rows(PF1, 0x02) == 0);     // the score's colours
  CHECK(rows(PF1, 0x01) == 0);     // reflection
  CHECK(rows(ENABL, 0x30) == 0);
  CHECK(rows(ENABL, 0x04) == 0);  // a player is there, too
  CHECK(rows(ENABL, 0x03) == kAll);
}

// The ball, which is placed elsewhere in each frame, in this colour on a background of $80.
Script moving_ball(int number, unsigned color) {
  return {write(0, 3, COLUPF, color), write(0, 9, COLUBK, 0x80), write(0, 15, ENABL, 2),
          write(1, 30 + 3 * number, RESBL, 0)};
}

TEST_CASE("The only object of a line may be anywhere if it has the colour of the background") {
  const auto rows = [](unsigned color, const Script& more) {
    return rows_that_recur([&](int number) {
      Script script = moving_ball(number, color);
      script.insert(script.end(), more.begin(), more.end());
      return script;
    });
  };
  CHECK(rows(0x80, {}) == kAll);
  CHECK(rows(0x82, {}) == 0);
  // It may meet a playfield of its colour, though that is not seen either.
  CHECK(rows(0x80, {write(0, 21, PF1, 0x18)}) == 0);
  // It is seen where one of the colours is written.
  Script recolored;
  for (int row = 0; row < 3; ++row) recolored.push_back(write(kFirstRow + row, 45, COLUBK, 0x84));
  for (int row = 0; row < 3; ++row) recolored.push_back(write(kFirstRow + row, 72, COLUBK, 0x80));
  CHECK(rows(0x80, recolored) == kAll - 3);
}

TEST_CASE("A hidden object that gets another colour than the background is seen") {
  const int rows = rows_that_recur([](int number) {
    Script script = moving_ball(0, 0x80);
    script.push_back(write(kFirstRow - 1, 60, COLUPF, number % 2 == 0 ? 0x80 : 0x2E));
    return script;
  });
  CHECK(rows == 0);
}

TEST_CASE("A late write after a line does not matter for it, whatever is not seen on it") {
  const int rows = rows_that_recur([](int number) {
    Script script = {write(0, 3, COLUPF, 0x2E), write(1, 30 + 3 * number, RESP0, 0)};
    for (int row = 0; row < kRows; ++row)
      script.push_back(write(kFirstRow + row, 75, PF1, row % 2 != 0 ? 0x3CU : 0xC3U));
    return script;
  });
  CHECK(rows == kAll);
}

// The mode moves missile 0 at the end of a line, unless an HMOVE in the cycle of the line's end comes first.
// Two rows show the missile. In two of three frames, the mode starts on line `start`.
void play_cosmic(int start) {
  rows_that_recur([start](int number) {
    Script script = {write(0, 3, ENAM0, 0), write(0, 9, COLUP0, 0x2E)};
    script.push_back(write(start - 1, 60, HMM0, number % 3 != 0 ? 0x70 : 0x50));
    script.push_back(write(start, 0, HMOVE, 0));
    script.push_back(write(start, 21, HMM0, 0x60));
    on_each_row(script, kLineCycles, HMOVE, 0);
    script.push_back(write(kFirstRow + kRows - 3, 3, ENAM0, 2));
    return script;
  });
}

TEST_CASE("A write at the end of a line comes before that end in Cosmic Ark's mode") {
  play_cosmic(kFirstRow - 1);
  play_cosmic(kFirstRow);
}

}  // namespace
}  // namespace racebeam::test

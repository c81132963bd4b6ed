// Collision latches that are read on lines which recur, before and after CXCLR, while a player moves.
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>

#include "tests/emulator/comparison.hpp"

namespace racebeam::test {
namespace {

constexpr int kFirstRow = 3, kRows = 8;
constexpr unsigned kPlayer0Latches = 2;  // CXP0FB: with the playfield and the ball

// What a line may do in these cycles: the playfield's two bars are shown in cycles 32 to 35 and 58 to 61.
constexpr std::array kMoments = {8, 26, 40, 52, 70};
enum Deed : unsigned { kNothing, kReads, kClears, kDeeds };

using Line = std::array<Deed, kMoments.size()>;

// Digit i of `number`, in base kDeeds, is what the line does in its i-th moment.
Line make_line(unsigned number) {
  Line line{};
  for (Deed& deed : line) {
    deed = static_cast<Deed>(number % kDeeds);
    number /= kDeeds;
  }
  return line;
}

constexpr unsigned kLines = 243;
static_assert(kLines == kDeeds * kDeeds * kDeeds * kDeeds * kDeeds);

Properties window() {
  Properties properties = ntsc();
  properties.ystart = kFirstRow;
  properties.height = kRows;
  return properties;
}

// The player is placed by a RESP0 in cycle `strobe`, and shown in three rows from `top` on. Only each
// `period`-th line clears the latches.
Script make_frame(const Line& line, int strobe, int top, int period = 1) {
  Script script = {{Access::kWrite, 3, PF1, 0x18},
                   {Access::kWrite, 9, GRP0, 0},
                   {Access::kWrite, kLineCycles + strobe, RESP0, 0}};
  for (int row = 0; row < kRows; ++row) {
    const int start = (kFirstRow + row) * kLineCycles;
    script.push_back({Access::kWrite, start + 3, GRP0, row >= top && row < top + 3 ? 0xFFU : 0U});
    for (std::size_t i = 0; i < line.size(); ++i) {
      const int cycle = start + kMoments[i];
      if (line[i] == kReads) script.push_back({Access::kLatches, cycle, kPlayer0Latches, 0});
      if (line[i] == kClears && row % period == 0) script.push_back({Access::kWrite, cycle, CXCLR, 0});
    }
  }
  return script;
}

constexpr int kFrameCycles = (kFirstRow + kRows + 2) * kLineCycles;

// A strobe in cycle 30 or 56 places the player on a bar. The others place it beside the bars.
constexpr std::array kStrobes = {30, 44, 56, 24, 56, 30};
constexpr int kFramesInPlace = 4;

TEST_CASE("Latches of lines that recur are those of the model, wherever a line reads or clears them") {
  for (unsigned number = 0; number < 2 * kLines; ++number) {
    const int period = 1 + static_cast<int>(number / kLines);
    INFO("line " << number % kLines << ", period " << period);
    const Line line = make_line(number);
    Comparison machines(window(), false);
    for (std::size_t frame = 0; frame < kStrobes.size() * kFramesInPlace; ++frame) {
      INFO("frame " << frame);
      const int strobe = kStrobes[frame / kFramesInPlace], top = static_cast<int>(frame / 2 % 3);
      machines.play(make_frame(line, strobe, top, period), kFrameCycles);
      machines.next_frame(kFrameCycles + kLineCycles);
    }
  }
}

// Plays the same frame several times. Returns how many rows were not drawn again in the last one.
int rows_that_recur(const Line& line, int strobe) {
  Bench bench(Rom(4096, 0xEA), window());
  for (int frame = 0; frame < 6; ++frame) {
    if (frame > 0) bench.next_frame(kFrameCycles + kLineCycles);
    for (const Access& access : make_frame(line, strobe, 2)) {
      if (access.kind == Access::kWrite)
        bench.store_at(access.cycle, access.reg, access.value);
      else
        bench.load_at(access.cycle, access.reg);
    }
    bench.write_at(kFrameCycles, 0x3F, 0);  // draws the picture to its end
    bench.end_step();
  }
  int rows = 0;
  for (std::size_t row = 0; row + 1 < kRows; ++row)  // the last one is never remembered
    rows += bench.pictures()[0].shows(row) == bench.pictures()[1].shows(row) ? 1 : 0;
  return rows;
}

TEST_CASE("Lines that read latches before CXCLR are not drawn again, except where the pair meets") {
  constexpr Line kReadThenClear = {kNothing, kNothing, kReads, kReads, kClears};
  constexpr int kBesideBars = 44, kOnBar = 30, kAll = kRows - 1, kWithPlayer = 3;
  CHECK(rows_that_recur(kReadThenClear, kBesideBars) == kAll);
  CHECK(rows_that_recur(kReadThenClear, kOnBar) == kAll - kWithPlayer);
}

}  // namespace
}  // namespace racebeam::test

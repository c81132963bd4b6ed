// Which lines are recorded, and for how long: rows of a picture, and rows that flicker.
#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "emulator/tia/frame_buffer.hpp"
#include "emulator/tia/line_cache/line_cache.hpp"

namespace racebeam::test {
namespace {

constexpr std::size_t kRows = 40;

// Adds a drawn line with this background colour.
LineNumber draw(LineCache& memory, std::size_t row, unsigned colour) {
  TiaRegisters registers;
  registers.color[3] = static_cast<std::uint8_t>(colour);
  LineRecord& record = memory.row(row);
  record.open(registers);
  record.view.seen = kLit;
  return memory.add(record);
}

// Draws frames with the row colours `colour(frame, row)`. Returns whether each row had its own record in
// the last two frames.
bool ends_with_two_sets(int frames, const std::function<unsigned(int, std::size_t)>& colour) {
  LineCache memory;
  std::set<const LineRecord*> last;
  for (int frame = 0; frame < frames; ++frame) {
    memory.begin_frame();
    memory.aim(kRows);
    for (std::size_t row = 0; row < kRows; ++row) {
      if (frame >= frames - 2) last.insert(&memory.row(row));
      const LineRecord& record = memory.row(row);
      const bool is_there = record.number != kNoLine && record.start.color[3] == colour(frame, row);
      if (!is_there) draw(memory, row, colour(frame, row));
    }
  }
  return last.size() == 2 * kRows;
}

TEST_CASE("Rows that flicker are remembered twice, others are not") {
  const auto flickers = [](int frame, std::size_t row) { return row < 12 && frame % 2 == 0 ? 0x1EU : 0U; };
  const auto stands_still = [](int, std::size_t row) { return static_cast<unsigned>(row); };
  const auto moves = [](int frame, std::size_t) { return static_cast<unsigned>(frame & 0xFF); };
  const auto stops = [&](int frame, std::size_t row) {
    return frame < 100 ? flickers(frame, row) : moves(frame, row);
  };
  CHECK(ends_with_two_sets(100, flickers));
  CHECK_FALSE(ends_with_two_sets(100, stands_still));
  CHECK_FALSE(ends_with_two_sets(100, moves));
  CHECK_FALSE(ends_with_two_sets(700, stops));
}

TEST_CASE("No two lines have the same number, on different machines either") {
  std::set<LineNumber> numbers = {kNoLine, kAnyLine};
  LineCache one, other;
  for (LineCache* memory : {&one, &other, &one}) {
    memory->begin_frame();
    memory->aim(kRows);
    for (std::size_t row = 0; row < kRows; ++row) CHECK(numbers.insert(draw(*memory, row, 0)).second);
  }
}

// A summarized record of a line with one write, HMM0 with this value.
LineRecord summarized(const TiaRegisters& registers, std::uint8_t motion) {
  LineCache memory;
  memory.aim(1);
  LineRecord& record = memory.row(0);
  CHECK(record.state() == LineState::kOpen);
  record.open(registers);
  const std::uint32_t log[] = {TiaWrite(10, HMM0, motion).packed(), TiaWrite(200, 0, 0).packed()};
  CHECK(record.add(log, 0) == log + 1);
  CHECK(record.state() == LineState::kOpen);
  memory.add(record);
  CHECK(record.state() == LineState::kDrawn);
  record.end = registers;
  record.summarize(false);
  CHECK(record.state() == LineState::kSummarized);
  LineRecord copy = record;
  record.open(registers);
  CHECK(record.state() == LineState::kOpen);
  return copy;
}

TEST_CASE("A record is open until its line is drawn, and no line starts with one that must be played") {
  TiaRegisters plain, moving;
  moving.cosmic = 1;
  CHECK(summarized(plain, 0x50).starts_with(RegisterVectors(plain)));
  CHECK_FALSE(summarized(plain, 0x60).starts_with(RegisterVectors(plain)));  // may start Cosmic Ark's mode
  CHECK_FALSE(summarized(moving, 0x50).starts_with(RegisterVectors(moving)));
}

// The record of a line that has been drawn: an HMOVE in cycle 3, and a write of 0 in cycle 10.
LineRecord drawn(const TiaRegisters& registers, unsigned reg) {
  LineCache memory;
  memory.aim(1);
  LineRecord& record = memory.open(0, registers);
  const std::uint32_t log[] = {TiaWrite(3, HMOVE, 0).packed(), TiaWrite(10, reg, 0).packed(),
                               TiaWrite(200, 0, 0).packed()};
  CHECK(record.add(log, 0) == log + 2);
  TiaState tia;
  static_cast<TiaRegisters&>(tia) = registers;
  tia.hmove_clock = 1009;
  record.close(tia, 1000);
  memory.add(record);
  CHECK(record.state() == LineState::kDrawn);
  return record;
}

TEST_CASE("A line that has just been drawn recurs if no register differs") {
  TiaRegisters registers;
  registers.player[0].position = 20;
  const LineRecord record = drawn(registers, COLUBK);
  CHECK(record.starts_with(RegisterVectors(registers)));
  CHECK(record.hmove_clock == 9);
  TiaRegisters hidden = registers;
  hidden.player[0].position = 21;
  CHECK_FALSE(record.starts_with(RegisterVectors(hidden)));
  CHECK(record.looks_like(RegisterVectors(hidden)));
  RegisterVectors passed(hidden);
  record.pass(passed);
  CHECK(passed.bytes_other_than(RegisterVectors(registers)) == 0);
}

TEST_CASE("A line that may start Cosmic Ark's mode, or has it, is played until it is summarized") {
  TiaRegisters plain, cosmic;
  cosmic.cosmic = 1;
  CHECK_FALSE(drawn(plain, HMM0).starts_with(RegisterVectors(plain)));
  CHECK_FALSE(drawn(cosmic, COLUBK).starts_with(RegisterVectors(cosmic)));
}

// The records of two rows: lines of one colour each, without a write, or the second one with one.
void fill(LineCache& memory, std::uint8_t first, std::uint8_t second, bool writes) {
  memory.begin_frame();
  memory.aim(2);
  for (std::size_t row = 0; row < 2; ++row) {
    TiaRegisters registers;
    registers.color[3] = row == 0 ? first : second;
    LineRecord& record = memory.open(row, registers);
    const std::uint32_t log[] = {TiaWrite(10, COLUPF, 2).packed(), TiaWrite(200, 0, 0).packed()};
    record.add(writes && row == 1 ? log : log + 1, 0);
    record.view.seen |= kLit;
    record.meetings = record.cleared = 0;
    memory.add(record);
    record.end = registers;
    record.summarize(false);
  }
}

TEST_CASE("A row repeats the one before if it has the same line, without a write") {
  const auto repeats = [](std::uint8_t first, std::uint8_t second, bool writes) {
    LineCache memory;
    fill(memory, first, second, writes);
    return memory.row(1).is_repetition_of(memory.row(0));
  };
  CHECK(repeats(0x1E, 0x1E, false));
  CHECK_FALSE(repeats(0x1E, 0x2E, false));
  CHECK_FALSE(repeats(0x1E, 0x1E, true));
}

TEST_CASE("A row repeats no line that changes its own start, or has other collisions") {
  LineCache memory, other;
  fill(memory, 0x1E, 0x1E, false);
  memory.row(0).end.color[3] = memory.row(1).end.color[3] = 0x2E;
  CHECK_FALSE(memory.row(1).is_repetition_of(memory.row(0)));
  fill(other, 0x1E, 0x1E, false);
  other.row(1).meetings = 1;
  CHECK_FALSE(other.row(1).is_repetition_of(other.row(0)));
}

TEST_CASE("A row no longer repeats the one before when one of them is drawn again") {
  LineCache memory;
  fill(memory, 0x1E, 0x1E, false);
  for (const std::size_t row : {0U, 1U}) {
    memory.row(1).repeats = true;
    memory.open(row, TiaRegisters{});
    CHECK_FALSE(memory.row(1).repeats);
  }
}

TEST_CASE("A row is copied from the other picture if that shows the line, and not else") {
  FrameBuffer picture, other;
  for (FrameBuffer* one : {&picture, &other}) one->make_room(2);
  other.pixels()[kLinePixels] = 0x42;
  other.shows(1) = 7;
  CHECK_FALSE(picture.copy_row(&other, 1, 8));
  CHECK_FALSE(picture.copy_row(&other, 0, 7));
  CHECK_FALSE(picture.copy_row(&other, 2, 7));
  CHECK_FALSE(picture.copy_row(nullptr, 1, 7));
  CHECK(picture.pixels()[kLinePixels] == 0);
  REQUIRE(picture.copy_row(&other, 1, 7));
  CHECK(picture.pixels()[kLinePixels] == 0x42);
  CHECK(picture.shows(1) == 7);
  picture.forget_lines();
  CHECK(picture.shows(1) == kAnyLine);
  picture.blank();
  CHECK(picture.rows() == 0);
  picture.make_room(2);
  CHECK(picture.pixels()[kLinePixels] == 0);
  CHECK(picture.shows(1) == kAnyLine);
}

}  // namespace
}  // namespace racebeam::test

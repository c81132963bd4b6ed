// A frame that nothing closes ends after 25,000 instructions (docs/spec/tia.md, 2), also where a wait for the
// timer is skipped and code without a jump follows.
#include <algorithm>
#include <catch2/catch.hpp>

#include "emulator/console.hpp"
#include "emulator/translator/translator.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

constexpr std::int64_t kBudget = 25000;

struct Row {
  std::uint8_t timer, value;  // the low byte of the register's address, and what is written
  int shift, length;          // of the timer's interval; instructions after the wait
  int frames;
  int turns;  // as ALE 0.12 counts them in frames 69 to 68 + `frames`
};

constexpr Row kRows[] = {{0x97, 0x10, 10, 2000, 399, 1560},
                         {0x97, 0x53, 10, 3000, 399, 370},
                         {0x97, 0xFF, 10, 3900, 100, 32},
                         {0x96, 0xFF, 6, 1000, 100, 442},
                         {0x95, 0x20, 3, 3900, 50, 315}};

// Sets the timer, waits until it is 0, runs the row, and counts the turn at $A0.
Rom program(const Row& row) {
  Rom rom = {0xA9, row.value, 0x8D, row.timer, 0x02, 0xAD, 0x84, 0x02, 0xD0, 0xFB};
  rom.resize(rom.size() + static_cast<std::size_t>(row.length), 0xEA);
  for (const int byte : {0xE6, 0xA0, 0xD0, 0x02, 0xE6, 0xA1, 0x4C, 0x00, 0xF0})
    rom.push_back(static_cast<std::uint8_t>(byte));
  rom.resize(4096, 0xEA);
  rom[0xFFC] = 0x00, rom[0xFFD] = 0xF0;
  return rom;
}

// The first read comes 4 cycles after the timer was set, and each other one 7 cycles later. INTIM is 0 from
// (value - 1) intervals on (docs/spec/riot.md, 3).
std::int64_t reads_of_timer(const Row& row) {
  const int zero_from = (row.value - 1) << row.shift;
  return 1 + std::max(0, (zero_from - 3 + 6) / 7);
}

// The turns in that many instructions from a reset, when the low byte of the count begins with 0.
int turns_in(const Row& row, std::int64_t instructions) {
  const std::int64_t to_count = 2 + 2 * reads_of_timer(row) + row.length + 1;
  int turns = 0;
  while (instructions >= to_count) {
    ++turns;
    instructions -= to_count + 2 + (turns % 256 == 0 ? 1 : 0);
  }
  return turns;
}

int count(const Console& console) { return console.ram()[0x20] | console.ram()[0x21] << 8; }

int turns_of(const Row& row, CpuKind cpu, int frames) {
  SystemGenerator generator(1);
  Console console(std::make_shared<const Rom>(program(row)), ntsc(), generator, cpu);
  console.set_ram(0x20, 0);
  console.set_ram(0x21, 0);
  for (int frame = 0; frame < frames; ++frame) console.step();
  return count(console);
}

TEST_CASE("A frame executes 25,000 instructions where a wait for the timer is skipped") {
  const bool translates = *Translator::obstacle() == '\0';
  for (const Row& row : kRows) {
    constexpr int kBefore = 69;  // frames of ALE's power-on
    const int end = kBefore + row.frames;
    const int expected = turns_in(row, kBudget * end), before = turns_in(row, kBudget * kBefore);
    INFO("timer " << int{row.value} << ", row of " << row.length);
    CHECK(expected - before == row.turns);
    CHECK(turns_of(row, CpuKind::kInterpreter, end) == expected);
    CHECK(turns_of(row, CpuKind::kAuto, end) == expected);
    if (translates) CHECK(turns_of(row, CpuKind::kTranslator, end) == expected);
  }
}

}  // namespace
}  // namespace racebeam::test

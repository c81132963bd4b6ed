// What a program is proven to overwrite before it reads it (environment/reset/boot_analysis.hpp).
#include "environment/reset/boot_analysis.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A program at $F000, in an image of NOPs.
BootFacts analysis_of(const Bytes& program, std::string_view scheme = "4K") {
  auto bytes = std::make_shared<Bytes>(4096, 0xEA);
  std::ranges::copy(program, bytes->begin());
  (*bytes)[0xFFC] = 0x00, (*bytes)[0xFFD] = 0xF0;
  SystemGenerator generator{1};
  Properties properties;
  properties.format = Format::kNtsc;
  const Console console{bytes, properties, generator};
  return analyze_boot(console, scheme);
}

bool proves_all(const BootFacts& facts) { return facts.clears_ram && facts.sets_timer && facts.sets_sound; }
bool proves_nothing(const BootFacts& facts) {
  return !facts.clears_ram && !facts.sets_timer && !facts.sets_sound;
}

// LDX #0; TXA; loop: STA 0,X; INX; BNE loop
constexpr std::initializer_list<std::uint8_t> kClears = {0xA2, 0, 0x8A, 0x95, 0, 0xE8, 0xD0, 0xFB};
constexpr std::initializer_list<std::uint8_t> kSetsTimer = {0x8D, 0x96, 2};  // STA TIM64T
constexpr std::uint8_t kJam = 0x02;                                          // an unknown instruction

Bytes sequence(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST_CASE("The analysis finds what a program overwrites before it reads it") {
  const Bytes reads_timer = {0xAD, 0x84, 2}, reads_ram = {0xA5, 0x80};
  CHECK(proves_all(analysis_of(sequence({kClears, {0xA9, 1}, kSetsTimer, reads_timer}))));
  const auto timer_is_read = analysis_of(sequence({kClears, reads_timer, kSetsTimer}));
  CHECK((timer_is_read.clears_ram && !timer_is_read.sets_timer && timer_is_read.sets_sound));
  CHECK(proves_nothing(analysis_of(sequence({reads_ram, kClears, kSetsTimer}))));
  const auto all_but_one_byte =
      analysis_of({0xA2, 0x81, 0x8A, 0x95, 0, 0xE8, 0xD0, 0xFB, 0x4C, 0, 0xF0});  // LDX #$81
  CHECK((!all_but_one_byte.clears_ram && !all_but_one_byte.sets_timer));
}

TEST_CASE("Each register of sound counts, and no other register of the TIA") {
  const Bytes all = {0x85, 0x15, 0x85, 0x16, 0x85, 0x17, 0x85, 0x18, 0x85, 0x19, 0x85, 0x1A};
  CHECK(analysis_of(all).sets_sound);
  for (std::size_t missing = 1; missing < all.size(); missing += 2) {
    for (const std::uint8_t other : Bytes{0x14, 0x1B}) {
      Bytes program = all;
      program[missing] = other;
      CHECK_FALSE(analysis_of(program).sets_sound);
    }
  }
}

TEST_CASE("The analysis ends after an endless loop") {
  CHECK(proves_nothing(analysis_of({0x4C, 0x00, 0xF0})));
}

// Programs at whose end Z is set, if each instruction does what the CPU does. Where a branch must not be
// taken, it leads to a jam, to an operand or past the end.
struct Program {
  const char* text;
  Bytes bytes;
};
const Program kPrograms[] = {
    {"LDA; CMP", {0xA9, 5, 0xC9, 5}},
    {"LDX; CPX", {0xA2, 5, 0xE0, 5}},
    {"LDY; CPY", {0xA0, 5, 0xC0, 5}},
    {"LDA sets Z", {0xA9, 0}},
    {"TAX", {0xA9, 7, 0xAA, 0xE0, 7}},
    {"TAY", {0xA9, 7, 0xA8, 0xC0, 7}},
    {"TXA", {0xA2, 7, 0x8A, 0xC9, 7}},
    {"TYA", {0xA0, 7, 0x98, 0xC9, 7}},
    {"TAX sets Z", {0xA2, 1, 0xA9, 0, 0xA2, 1, 0xAA}},
    {"SP after a reset", {0xBA, 0xE0, 0xFF}},
    {"A after a reset", {0x48, 0x68}},
    {"X after a reset", {0x8A}},
    {"Y after a reset", {0x98}},
    {"TXS, TSX", {0xA2, 0x90, 0x9A, 0xA2, 0, 0xBA, 0xE0, 0x90}},
    {"TXS sets no flag", {0xA2, 0x90, 0xA9, 0, 0x9A}},
    {"INX", {0xA2, 0xFF, 0xE8}},
    {"DEX", {0xA2, 1, 0xCA}},
    {"INY", {0xA0, 0xFF, 0xC8}},
    {"DEY", {0xA0, 1, 0x88}},
    {"INC", {0xA9, 0xFF, 0x85, 0x80, 0xE6, 0x80}},
    {"INC writes", {0xA9, 4, 0x85, 0x80, 0xE6, 0x80, 0xA5, 0x80, 0xC9, 5}},
    {"DEC", {0xA9, 1, 0x85, 0x80, 0xC6, 0x80}},
    {"DEC writes", {0xA9, 4, 0x85, 0x80, 0xC6, 0x80, 0xA5, 0x80, 0xC9, 3}},
    {"AND", {0xA9, 6, 0x29, 3, 0xC9, 2}},
    {"ORA", {0xA9, 6, 0x09, 3, 0xC9, 7}},
    {"EOR", {0xA9, 6, 0x49, 3, 0xC9, 5}},
    {"BNE is taken", {0xA9, 1, 0xD0, 1, kJam, 0xA9, 0}},
    {"BNE is not taken", {0xA9, 0, 0xD0, 2, 0xF0, 1, kJam}},
    {"BEQ is not taken", {0xA9, 1, 0xF0, 2, 0xD0, 1, kJam, 0xA9, 0}},
    {"BPL is taken", {0xA9, 0x7F, 0x10, 1, kJam, 0xA9, 0}},
    {"BPL is not taken", {0xA9, 0x80, 0x10, 1, 0xA9, 0}},
    {"BMI is taken", {0xA9, 0x80, 0x30, 1, kJam, 0xA9, 0}},
    {"BMI is not taken", {0xA9, 0x7F, 0x30, 1, 0xA9, 0}},
    {"a branch back", {0xA2, 2, 0xCA, 0xD0, 0xFD}},
    {"CMP with the same sets C", {0xA9, 5, 0xC9, 5, 0xB0, 1, kJam}},
    {"CMP with less sets C", {0xA9, 5, 0xC9, 4, 0xB0, 1, kJam, 0xA9, 0}},
    {"CMP with more clears C", {0xA9, 5, 0xC9, 6, 0x90, 1, kJam, 0xA9, 0}},
    {"BCS is not taken", {0x18, 0xB0, 1, 0xA9, 0}},
    {"BCC is not taken", {0x38, 0x90, 1, 0xA9, 0}},
    {"PHA, PLA", {0xA9, 5, 0x48, 0xA9, 0, 0x68, 0xC9, 5}},
    {"PLA sets Z", {0xA9, 0, 0x48, 0xA9, 1, 0x68}},
    {"PHA writes RAM", {0xA9, 5, 0x48, 0xA9, 0, 0xA5, 0xFF, 0xC9, 5}},
    {"JMP", {0x4C, 0x04, 0xF0, kJam, 0xA9, 0}},
    {"JSR, RTS", {0x20, 0x07, 0xF0, 0xA9, 0, 0xF0, 3, 0xA9, 1, 0x60}},
    {"JSR pushes the low byte last", {0x20, 0x03, 0xF0, 0x68, 0xC9, 2}},
    {"JSR pushes the high byte first", {0x20, 0x03, 0xF0, 0x68, 0x68, 0xC9, 0xF0}},
    {"instructions without effect here", {0xA9, 0, 0x78, 0xD8, 0xB8, 0xEA}},
    {"a byte of the program", {0xAD, 0x01, 0xF0, 0xC9, 0x01}},
    {"the last byte before the hot spots", {0xAD, 0xBF, 0xFF, 0xC9, 0xEA, 0x8D, 0xBF, 0xFF}},
    {"absolute, and a mirror", {0xA9, 5, 0x8D, 0x80, 0x00, 0xA9, 0, 0xAD, 0x80, 0x01, 0xC9, 5}},
    {"zero page, X", {0xA9, 5, 0xA2, 0xF0, 0x95, 0x90, 0xA9, 0, 0xA5, 0x80, 0xC9, 5}},
    {"zero page, Y", {0xA9, 5, 0x85, 0x80, 0xA0, 0xF0, 0xB6, 0x90, 0xE0, 5}},
    {"absolute, X", {0xA9, 5, 0x85, 0x80, 0xA2, 0x90, 0xBD, 0xF0, 0xFF, 0xC9, 5}},
    {"absolute, Y", {0xA9, 5, 0x85, 0x80, 0xA0, 0x90, 0xB9, 0xF0, 0xFF, 0xC9, 5}},
    {"STX", {0xA2, 5, 0x86, 0x80, 0xA5, 0x80, 0xC9, 5}},
    {"STY", {0xA0, 5, 0x84, 0x80, 0xA5, 0x80, 0xC9, 5}},
};

TEST_CASE("The analysis follows each instruction as the CPU executes it") {
  for (const Program& program : kPrograms) {
    INFO(program.text);
    const Bytes goes_on_if_zero = {0xF0, 1, kJam};
    CHECK(proves_all(analysis_of(sequence({program.bytes, goes_on_if_zero, kClears, kSetsTimer}))));
  }
}

TEST_CASE("The analysis ends where something is read that is not known") {
  const Program programs[] = {
      {"RAM that was not written", {0xA9, 0, 0x85, 0x80, 0xA5, 0x81}},
      {"the TIA", {0xA5, 0x02}},
      {"the RIOT's ports", {0xAD, 0x80, 0x02}},
      {"a hot spot, read", {0xAD, 0xC0, 0xFF}},
      {"a hot spot, written", {0x8D, 0xC0, 0xFF}},
      {"the stack before a push", {0x68}},
      {"Z at first", {0xD0, 0}},
      {"N at first", {0x10, 0}},
      {"C at first", {0x90, 0}},
      {"a pointer", {0xA9, 0, 0x85, 0x80, 0x85, 0x81, 0xB1, 0x80}},
      {"JMP through a pointer", {0x6C, 0x03, 0xF0, 0x05, 0xF0}},
      {"an addition", {0x69, 0}},
      {"an undocumented NOP", {0x04, 0x80}},
  };
  for (const Program& program : programs) {
    INFO(program.text);
    CHECK(proves_nothing(analysis_of(sequence({program.bytes, kClears, kSetsTimer}))));
  }
}

TEST_CASE("Only a write to a timer's register sets the timer") {
  for (const std::uint8_t low : Bytes{0x94, 0x95, 0x96, 0x97, 0x9C, 0x9F})
    CHECK(analysis_of({0x8D, low, 2}).sets_timer);
  for (const std::uint8_t low : Bytes{0x80, 0x84, 0x90, 0x93})
    CHECK_FALSE(analysis_of({0x8D, low, 2}).sets_timer);
}

TEST_CASE("Only schemes that show plain memory are analysed") {
  const Bytes program = sequence({kClears, kSetsTimer});
  for (const auto* scheme : {"2K", "4K", "F8", "F8 swapped", "F6", "F4", "E0", "MB"})
    CHECK(proves_all(analysis_of(program, scheme)));
  for (const auto* scheme : {"F8SC", "FE", "3F", ""}) CHECK(proves_nothing(analysis_of(program, scheme)));
}

}  // namespace
}  // namespace racebeam

// CDFJ and CDFJ+: programs of the 6507 and of the ARM (docs/spec/cartridges.md, 15). schemes_random_test.cpp
// compares the registers with a model.
#include <algorithm>
#include <catch2/catch.hpp>

#include "emulator/cartridge/harmony/cdf.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/emulator/cartridge/both_processors.hpp"
#include "tests/emulator/reference/reference_cdf.hpp"
#include "tests/support/thumb_code.hpp"

namespace racebeam::test {
namespace {

using namespace thumb;
using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kStart = 0x1100, kBank = 4096;
constexpr unsigned kWhole = 0x100;  // an increment of one byte

Properties asking_for_cdf(const char* scheme) {
  Properties properties = ntsc();
  properties.scheme = scheme;
  return properties;
}

void put_word(Bytes& bytes, std::size_t at, std::uint32_t number) {
  for (unsigned i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(number >> (8 * i));
}

// All banks have `code` at $1100, and their number at $1080. All streams read byte by byte.
Rom image(const Bytes& code, std::initializer_list<Code> arm = {bx(kLr)}, bool is_plus = false) {
  Rom rom(cdf::kImage);
  for (unsigned i = 0; i < 35; ++i) put_word(rom, 0x124 + 4 * i, kWhole);
  for (unsigned bank = 0; bank < cdf::kBanks; ++bank) {
    std::uint8_t* bytes = &rom[(is_plus ? 0x800 : 0x1000) + kBank * bank];
    std::ranges::copy(code, bytes + kStart % kBank);
    bytes[0x80] = static_cast<std::uint8_t>(0x50 + bank);
    bytes[0xFFD] = kStart >> 8 | 0xE0;
  }
  put(rom, is_plus ? 0x7800 : 0x808, arm);
  if (!is_plus) return rom;
  put_word(rom, 0x17F4, 0x40001FDC);
  put_word(rom, 0x17F8, 0x7801);
  return rom;
}

struct Running : Bench {
  explicit Running(const Rom& rom, bool is_plus = false)
      : Bench(rom, asking_for_cdf(is_plus ? "CDFJ+" : "CDFJ")) {
    cpu.PC = kStart;
    cpu.SP = 0xFF;
  }
  std::uint8_t& ram(unsigned at) { return board.cartridge_ram[at]; }
  std::uint8_t& display(unsigned at) { return ram(0x800 + at); }
};

TEST_CASE("CDFJ: a reset selects the bank with the program, and copies the driver to RAM") {
  for (const bool is_plus : {false, true}) {
    Running bench(image({}, {}, is_plus), is_plus);
    CHECK(unsigned{bench.see(0x1080)} == (is_plus ? 0x50 : 0x56));
    for (const unsigned bank : {0U, 3U, 6U}) {
      bench.write_at(0, (is_plus ? 0x1FF4 : 0x1FF5) + bank, 0);
      CHECK(unsigned{bench.see(0x1080)} == 0x50 + bank);
    }
    bench.write_at(0, 0x1FF0, 0xEE);
    CHECK(unsigned{bench.display(0)} == 0xEE);
    bench.board.slot.scheme.reset(bench.board.slot);
    CHECK(unsigned{bench.display(0)} == 0);
    CHECK(unsigned{bench.ram(0x125)} == 1);
  }
}

TEST_CASE("CDFJ: the upper byte of the pointer is written first, and bytes go on from there") {
  Running bench(image({}));
  for (const unsigned value : {0x02U, 0x34U}) bench.write_at(0, 0x1FF1, value);
  for (const unsigned value : {0xA1U, 0xA2U}) bench.write_at(0, 0x1FF0, value);
  CHECK(unsigned{bench.display(0x234)} == 0xA1);
  CHECK(unsigned{bench.display(0x235)} == 0xA2);
}

// LDX #0; STX SETMODE: fast fetch on. Y and X are not exchanged.
TEST_CASE("CDFJ: LDA # reads streams, and a jump goes through one") {
  const Bytes code = {0xA2, 0x00, 0x8E, 0xF2, 0x1F,  // on
                      0xA9, 0x05, 0x85, 0x80,        // LDA #DS5DATA
                      0xA9, 0x05, 0x85, 0x81,        //
                      0xA0, 0x05,                    // LDY #5
                      0xA9, 0x24, 0x85, 0x82,        // LDA #$24: behind the last register
                      0x4C, 0x01, 0x00};             // JMP FASTJMP2
  Running bench(image(code));
  bench.display(0) = 0x11, bench.display(1) = 0x22;
  put_word(bench.board.cartridge_ram, 0x98 + 4 * 34, 1U << 20);
  bench.display(1) = 0x34, bench.display(2) = 0x15;
  bench.run_program(10);
  CHECK(unsigned{bench.state.riot.ram[0]} == 0x11);
  CHECK(unsigned{bench.state.riot.ram[1]} == 0x34);
  CHECK(unsigned{bench.state.riot.ram[2]} == 0x24);
  CHECK(unsigned{bench.cpu.Y} == 5);
  CHECK(unsigned{bench.cpu.PC} == 0x1534);
}

TEST_CASE("CDFJ+: LDX # and LDY # read streams if the driver says so, from the number that it names on") {
  const Bytes code = {0xA9, 0x00, 0x8D, 0xF2, 0x1F, 0xA2, 0xC8, 0xA0, 0xC9, 0xA9, 0x05};
  for (const bool has_y : {false, true}) {
    Rom rom = image(code, {bx(kLr)}, true);
    put_choices(rom, true, has_y, 200);
    put_word(rom, 0x98 + 4, 3U << 16);
    Running bench(rom, true);
    bench.display(0) = 0x77, bench.display(3) = 0x66;
    bench.run_program(5);
    CHECK(unsigned{bench.cpu.X} == 0x77);
    CHECK(unsigned{bench.cpu.Y} == (has_y ? 0x66U : 0xC9U));
    CHECK(unsigned{bench.cpu.A} == 0x05);
  }
}

// The display data begin at $40000800. What a function gives is stored there.
TEST_CASE("CDFJ: the driver's functions set and give the phase of a voice") {
  const auto call = [](unsigned function) {
    return std::array<Code, 4>{mov_number(4, function), add(4, 4, 5), mov_any(kLr, kPc), bx(4)};
  };
  const auto set_note = call(1), reset_wave = call(5), wave_pointer = call(9), wave_size = call(13);
  for (const bool resets : {false, true}) {
    std::vector<Code> program = {mov_any(7, kLr),  mov_number(6, 1), lsl(6, 6, 30),       mov_number(0, 8),
                                 lsl(0, 0, 8),     add(6, 6, 0),     mov_number(5, 0x75), lsl(5, 5, 4),
                                 mov_number(2, 1), mov_number(3, 3), lsl(3, 3, 27)};
    const auto append = [&](const auto& codes) { program.insert(program.end(), codes.begin(), codes.end()); };
    if (resets) append(reset_wave);
    append(wave_pointer);
    append(std::array<Code, 2>{str(2, 6, 0), mov_number(2, 1)});
    append(set_note);
    append(std::array<Code, 1>{mov_number(3, 30)});
    append(wave_size);
    append(std::array<Code, 1>{bx(7)});
    Rom rom = image({0xA2, 0xFF, 0x8E, 0xF3, 0x1F, 0xEA, 0x4C, 0x00, 0x11});
    std::size_t at = 0x808;
    for (const Code one : program) put(rom, at, {one}), at += 2;
    Running bench(rom);
    const auto& chip = *reinterpret_cast<const cdf::Chip*>(bench.state.cartridge.ram.data());
    bench.run_program(3);
    CHECK(chip.stopped == 0);
    CHECK(chip.clock.voice[1].frequency == 0x18000000);
    CHECK(unsigned{chip.wave[1]} == 30);
    bench.next_frame(bench.state.cycle);
    bench.state.cycle += 1000;
    bench.run_program(4);  // JMP comes first
    CHECK((bench.display(3) != 0) == !resets);
  }
}

TEST_CASE("CDFJ: after a fault, or a call that never ends, the ARM stands still") {
  for (const Code last : {code(0xDE00), kForEver, bx(kLr)}) {
    const Rom rom = image({0xA2, 0xFF, 0x8E, 0xF3, 0x1F, 0xEA, 0x4C, 0x00, 0x11},
                          {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 8), lsl(2, 2, 8), add(1, 1, 2),
                           ldrb(3, 1, 0), add_number(3, 1), strb(3, 1, 0), last});
    Running bench(rom);
    bench.run_program(4 * 10);
    CHECK(unsigned{bench.display(0)} == (last == bx(kLr) ? 10 : 1));
  }
}

TEST_CASE("CDFJ: the amplitude is that of waves, or of a sample") {
  Running bench(image({0xA9, 0x23, 0x85, 0x80, 0xA9, 0x23, 0x85, 0x81}));
  put_word(bench.board.cartridge_ram, 0x1B0, 0x40000800);
  put_word(bench.board.cartridge_ram, 0x1B4, 0x40000820);
  put_word(bench.board.cartridge_ram, 0x1B8, 0x40000840);
  bench.display(0) = 0x5A, bench.display(0x20) = 3, bench.display(0x40) = 4;
  bench.write_at(0, 0x1FF2, 0xF0);
  bench.run_program(2);
  CHECK(unsigned{bench.state.riot.ram[0]} == 0x61);
  bench.write_at(0, 0x1FF2, 0x00);
  bench.run_program(2);
  CHECK(unsigned{bench.state.riot.ram[1]} == 5);
}

// Calls, jumps through streams, and fast fetch in every second frame.
TEST_CASE("CDFJ: the translator does what the interpreter does") {
  const Bytes program = {0xE6, 0x80, 0xA5, 0x80, 0x29, 0x01, 0x8D, 0xF2, 0x1F,              // fast fetch
                         0xA2, 0xFE, 0x8E, 0xF3, 0x1F,                                      // call
                         0xA2, 0x20, 0xA9, 0x05, 0x85, 0x1B, 0xAD, 0x09, 0x11, 0x85, 0x0D,  // 32 lines
                         0x85, 0x02, 0xCA, 0xD0, 0xF2,                                      //
                         0xA2, 0x42, 0x86, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA2, 0x30, 0x86,
                         0x00, 0x4C, 0x00, 0xF1};
  const Rom rom =
      image(program, {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 8), lsl(2, 2, 8), add(1, 1, 2),
                      ldrb(3, 1, 0), add_number(3, 5), strb(3, 1, 0), strb(3, 1, 17), bx(kLr)});
  compare_processors(rom, asking_for_cdf("CDFJ"), 0x800);
}

}  // namespace
}  // namespace racebeam::test

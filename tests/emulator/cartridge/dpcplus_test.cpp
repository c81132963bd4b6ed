// DPC+: programs of the 6507 and of the ARM (docs/spec/cartridges.md, 14). schemes_random_test.cpp compares
// the registers with a model.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "emulator/cartridge/arm/memory.hpp"
#include "emulator/cartridge/harmony/dpcplus.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/emulator/cartridge/both_processors.hpp"
#include "tests/support/thumb_code.hpp"

namespace racebeam::test {
namespace {

using namespace thumb;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kBank = 4096, kSize = 32768;
constexpr unsigned kStart = 0x1100;

Properties asking_for_dpcplus() {
  Properties properties = ntsc();
  properties.scheme = "DPC+";
  return properties;
}

// Byte k of the display data is k / 16, and of the frequencies k. All banks have `code` at $1100.
Rom image(const Bytes& code = {}, std::initializer_list<Code> arm = {bx(kLr)}, std::size_t size = kSize) {
  Rom rom(size);
  const std::size_t base = size - dpcplus::kMinImage;
  for (std::size_t i = 0; i < base; ++i) rom[i] = static_cast<std::uint8_t>(i + 1);
  for (std::size_t bank = 0; bank < dpcplus::kBanks; ++bank) {
    std::uint8_t* bytes = &rom[base + kBank * bank];
    std::ranges::copy(code, bytes + kStart % kBank);
    bytes[0x80] = static_cast<std::uint8_t>(0x50 + bank);
    bytes[0xFFD] = kStart >> 8 | 0xE0;
  }
  for (std::size_t i = 0; i < 4096; ++i) rom[size - 5120 + i] = static_cast<std::uint8_t>(i / 16);
  for (std::size_t i = 0; i < 1024; ++i) rom[size - 1024 + i] = static_cast<std::uint8_t>(i);
  put(rom, base + 8, arm);
  return rom;
}

Bench start(const Bytes& code, std::initializer_list<Code> arm = {bx(kLr)}) {
  Bench bench(image(code, arm), asking_for_dpcplus());
  bench.cpu.PC = kStart;
  return bench;
}

unsigned display(const Bench& bench, std::size_t at) { return bench.board.cartridge_ram[3072 + at]; }

TEST_CASE("DPC+: a reset selects bank 5, and copies all but the banks to RAM") {
  for (const std::size_t size : {std::size_t{29696}, std::size_t{30000}, kSize}) {
    INFO(size << " bytes");
    const Rom rom = image({}, {}, size);
    Bench bench(rom, asking_for_dpcplus());
    CHECK(unsigned{bench.see(0x1080)} == 0x55);
    for (const unsigned bank : {0U, 3U, 5U}) {
      bench.write_at(0, 0x1FF6 + bank, 0);
      CHECK(unsigned{bench.see(0x1080)} == 0x50 + bank);
    }
    bench.write_at(0, 0x1078, 0xEE);  // the first byte of the display data
    bench.write_at(0, 0x1071, 0x77);
    CHECK(display(bench, 0) == 0xEE);
    bench.board.slot.scheme.reset(bench.board.slot);
    bench.board.map_memory();
    CHECK(unsigned{bench.see(0x1080)} == 0x55);
    CHECK(unsigned{bench.see(0x1002)} == 0x50);  // byte 1 of $2B435044
    const Bytes& ram = bench.board.cartridge_ram;
    REQUIRE(ram.size() == 8192);
    const auto driver = static_cast<std::ptrdiff_t>(size - 29696);
    CHECK(std::equal(rom.begin(), rom.begin() + driver, ram.begin()));
    CHECK(std::all_of(ram.begin() + driver, ram.begin() + 3072, [](std::uint8_t byte) { return byte == 0; }));
    CHECK(std::equal(rom.end() - 5120, rom.end(), ram.begin() + 3072));
  }
}

TEST_CASE("DPC+: an image is found by its text, and has 29696 to 32768 bytes") {
  const auto with_text = [](std::size_t size) {
    Rom rom(size, 0x11);
    const std::string text = "DPC+";
    std::ranges::copy(text, rom.begin() + 700);
    return rom;
  };
  CHECK(scheme_of(with_text(29696)).name == "DPC+");
  CHECK(scheme_of(with_text(32768)).name == "DPC+");
  CHECK_THROWS_WITH(
      scheme_of(with_text(16384)),
      "the cartridge scheme DPC+ needs an image of at least 29696 bytes; this one has 16384 bytes");
  for (const std::size_t size : {32769, 65536})
    CHECK_THROWS_WITH(scheme_of(with_text(size)),
                      "the cartridge scheme DPC+ needs an image of at most 32768 bytes; this one has " +
                          std::to_string(size) + " bytes");
}

TEST_CASE("DPC+: function 1 copies from banks, display data and frequencies of the image") {
  const Rom rom = image();
  const auto at = [&](std::size_t offset) { return unsigned{rom[3072 + offset]}; };
  Bench bench(rom, asking_for_dpcplus());
  for (unsigned i = 0; i < 8; ++i) bench.write_at(0, 0x1078, 0xEE);  // in RAM, the display data differ now
  for (const unsigned from : {0x1080U, 0x5FFEU, 0x6000U, 0x64A4U, 0x6FFEU, 0x73FEU}) {
    INFO("from offset " << from);
    bench.write_at(0, 0x1052, 0x40);  // fetcher 2 at $0240
    bench.write_at(0, 0x106A, 0x02);
    for (const unsigned parameter : {from & 0xFF, from >> 8, 2U, 4U})
      bench.write_at(0, 0x1059, static_cast<std::uint8_t>(parameter));
    bench.write_at(0, 0x105A, 1);
    for (unsigned i = 0; i < 4; ++i) CHECK(display(bench, 0x240 + i) == at((from + i) % 29696));
  }
}

TEST_CASE("DPC+: fast fetch exchanges the operands of LDA # that name a register") {
  const Bytes code = {0xA9, 0x00, 0x8D, 0x58, 0x10,  // LDA #0; STA $1058: on
                      0xA9, 0x20, 0x8D, 0x50, 0x10,  // LDA #$20: the flag of fetcher 0, which is 0 here
                      0xA9, 0x08, 0xAA,              // LDA #$08: display[pointer 0]
                      0xA0, 0x08,                    // LDY #$08
                      0xA9, 0x28,                    // LDA #$28
                      0x8D, 0x58, 0x10,              // off
                      0xA9, 0x08};                   // LDA #$08
  Bench bench = start(code);
  bench.write_at(0, 0x1068, 0x7);
  bench.run_program(6);
  CHECK(unsigned{bench.cpu.X} == 0x70);
  bench.run_program(1);
  CHECK(unsigned{bench.cpu.Y} == 0x08);
  bench.run_program(1);
  CHECK(unsigned{bench.cpu.A} == 0x28);
  bench.run_program(2);
  CHECK(unsigned{bench.cpu.A} == 0x08);
}

TEST_CASE("DPC+: fast fetch knows opcodes from operands and data, and leaves RAM as it is") {
  const Bytes code = {0xA2, 0xA9,        // LDX #$A9: not an opcode
                      0x08,              // PHP
                      0xAD, 0x0B, 0x11,  // LDA $110B, which has $A9
                      0x20, 0x80, 0x00,  // JSR $0080
                      0xEA, 0xEA, 0xA9};
  Bench bench = start(code);
  bench.write_at(0, 0x1058, 0);
  bench.cpu.SP = 0xFF;
  const Bytes in_ram = {0xA9, 0x08};  // LDA #$08
  std::ranges::copy(in_ram, bench.state.riot.ram.begin());
  const auto pointer = bench.state.cartridge.ram;
  bench.run_program(4);
  CHECK(unsigned{bench.cpu.X} == 0xA9);
  CHECK(unsigned{bench.cpu.PC} == 0x0080);
  bench.run_program(1);
  CHECK(unsigned{bench.cpu.A} == 0x08);
  CHECK(std::equal(pointer.begin(), pointer.begin() + sizeof(dpcplus::Fetcher),
                   bench.state.cartridge.ram.begin()));
}

// RTS ends with a read of the third byte of JSR, here $F1, which would be an opcode of two bytes.
TEST_CASE("DPC+: fast fetch exchanges the operand of LDA # behind a subroutine") {
  const Bytes code = {0x20, 0x08, 0xF1,                                // JSR $F108
                      0xA9, 0x08, 0xAA, 0xEA, 0xEA, 0x20, 0x80, 0x00,  // JSR $0080, which has RTS
                      0x60};
  Bench bench = start(code);
  bench.write_at(0, 0x1058, 0);
  bench.write_at(0, 0x1068, 0x7);  // display[$700] = $70
  bench.cpu.SP = 0xFF;
  bench.state.riot.ram[0] = 0x60;
  bench.run_program(4);
  CHECK(unsigned{bench.cpu.PC} == 0x1103);
  bench.run_program(2);
  CHECK(unsigned{bench.cpu.X} == 0x70);
}

// R1 = the display data. Then a word there is R0, SP or LR.
TEST_CASE("DPC+: a call runs the ARM at the next access, with the registers of the library's start") {
  const Bytes code = {0xA9, 0xFF, 0x8D, 0x5A, 0x10,  // LDA #$FF; STA $105A
                      0xAD, 0x08, 0x10};             // LDA $1008
  Bench bench = start(code, {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 3), lsl(2, 2, 10), add(1, 1, 2),
                             str(0, 1, 0), mov_any(3, 13), str(3, 1, 4), mov_any(3, kLr), str(3, 1, 8),
                             mov_number(4, 0xBC), strb(4, 1, 0), bx(kLr)});
  bench.run_program(2);
  CHECK(display(bench, 0) == 0);
  const int before = bench.state.cycle;
  bench.run_program(1);
  CHECK(bench.state.cycle == before + 4);
  CHECK(unsigned{bench.cpu.A} == 0xBC);
  const std::uint8_t expected[] = {0xBC, 0x0C, 0, 0, 0xDC, 0x1F, 0x00, 0x40, 0, 0, 0, 0x40};
  CHECK(std::equal(std::begin(expected), std::end(expected), bench.board.cartridge_ram.begin() + 3072));
}

// A program for the ARM that counts its calls in the display data, and then goes on with `rest`.
Rom counting(std::initializer_list<Code> rest) {
  const Bytes code = {0xA9, 0xFF, 0x8D, 0x5A, 0x10, 0xEA, 0xA5, 0x80, 0xE6, 0x81, 0x4C, 0x00, 0x11};
  Rom rom = image(code, {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 3), lsl(2, 2, 10), add(1, 1, 2),
                         ldrb(3, 1, 0), add_number(3, 1), strb(3, 1, 0)});
  put(rom, 3072 + 8 + 16, rest);
  return rom;
}

unsigned calls_in(const Rom& rom, int rounds, Bench* given = nullptr) {
  Bench own(rom, asking_for_dpcplus());
  Bench& bench = given != nullptr ? *given : own;
  bench.cpu.PC = kStart;
  const unsigned before = display(bench, 0);
  bench.run_program(6 * rounds);
  return (display(bench, 0) - before) & 0xFF;
}

TEST_CASE("DPC+: after a fault, or a call that never ends, the ARM stands still until a reset") {
  for (const Code last : {code(0xDE00), kForEver, bx(kLr)}) {
    INFO(std::hex << last);
    const bool ends = last == bx(kLr);
    const Rom rom = counting({last});
    Bench bench(rom, asking_for_dpcplus());
    CHECK(calls_in(rom, 10, &bench) == (ends ? 10 : 1));
    CHECK(unsigned{bench.state.riot.ram[1]} == 10);  // the 6507 goes on
    bench.board.slot.scheme.reset(bench.board.slot);
    bench.board.map_memory();
    CHECK(calls_in(rom, 10, &bench) == (ends ? 10 : 1));
  }
}

// Half of all instructions, and some more. A call counts before it is known whether it returns.
Rom lengthy() {
  return counting({mov_number(0, 35), lsl(0, 0, 13), sub_number(0, 1), branch_if(kNe, -2), bx(kLr)});
}

TEST_CASE("DPC+: the ARM has a million instructions, and more for each cycle that has passed") {
  const Rom rom = lengthy();
  CHECK(calls_in(rom, 10) == 3);
  Bench bench(rom, asking_for_dpcplus());
  CHECK(calls_in(rom, 1, &bench) == 1);
  bench.next_frame(bench.state.cycle + 40000);  // all of them again
  CHECK(calls_in(rom, 10, &bench) == 3);
  bench.next_frame(bench.state.cycle + 40000);
  CHECK(calls_in(rom, 10, &bench) == 0);
}

void call_at(Bench& bench, int cycle) {
  bench.write_at(cycle, 0x105A, 0xFF);
  bench.see(0x1080, cycle);
}

TEST_CASE("DPC+: a frame that does not end gives the ARM instructions for 32768 cycles") {
  Bench bench(lengthy(), asking_for_dpcplus());
  for (int call = 0; call < 10; ++call) call_at(bench, 100000 * call);
  CHECK(display(bench, 0) == 3);
}

TEST_CASE("DPC+: a clock that is ahead, in a state from elsewhere, gives the ARM no instructions") {
  Bench bench(lengthy(), asking_for_dpcplus());
  for (int call = 0; call < 10; ++call) {
    bench.state.frame.cartridge_clock = 50;
    call_at(bench, 0);
  }
  CHECK(display(bench, 0) == 2);
}

TEST_CASE("DPC+: three voices are waves of the display data, 20000 samples a second") {
  Bench bench(image(), asking_for_dpcplus());
  bench.write_at(0, 0x105D, 4);     // display[128 + 0 to 31]: 8 and 9
  bench.write_at(0, 0x105E, 0x80);  // 7 bits: the same as 0
  bench.write_at(0, 0x1075, 8);     // $23222120: 0.137 of the wave a sample
  CHECK(unsigned{bench.see(0x1005, 0)} == 8);
  const auto after = [&](int samples) { return unsigned{bench.see(0x1005, samples * 3579575 / 60000 + 1)}; };
  CHECK(after(3) == 8);
  CHECK(after(4) == 9);
  CHECK(after(7) == 9);
  CHECK(after(8) == 8);
}

// Calls, and fast fetch in every second frame.
TEST_CASE("DPC+: the translator does what the interpreter does") {
  const Bytes program = {0xE6, 0x80, 0xA5, 0x80, 0x29, 0x01, 0x8D, 0x58, 0x10,              // fast fetch
                         0xA9, 0xFE, 0x8D, 0x5A, 0x10,                                      // call
                         0xA2, 0x20, 0xA9, 0x08, 0x85, 0x1B, 0xAD, 0x09, 0x10, 0x85, 0x0D,  // 32 lines
                         0x85, 0x02, 0xCA, 0xD0, 0xF2,                                      //
                         0xA9, 0x42, 0x85, 0x00, 0x85, 0x02, 0x85, 0x02, 0xA9, 0x30, 0x85,
                         0x00, 0x4C, 0x00, 0xF1};
  const Rom rom =
      image(program, {mov_number(1, 1), lsl(1, 1, 30), mov_number(2, 3), lsl(2, 2, 10), add(1, 1, 2),
                      ldrb(3, 1, 0), add_number(3, 5), strb(3, 1, 0), strb(3, 1, 17), bx(kLr)});
  compare_processors(rom, asking_for_dpcplus(), 3072);
}

}  // namespace
}  // namespace racebeam::test

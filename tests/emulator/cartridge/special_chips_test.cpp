// Schemes with more than banks: DPC's chip, AR's loads, cartridges at the TIA's addresses, resets, and code
// that runs from cartridge RAM or across hot spots (docs/spec/cartridges.md, 5 to 10).
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

Properties asking_for(std::string_view scheme) {
  Properties properties = ntsc();
  properties.scheme = scheme;
  return properties;
}

// Byte k of slice s is 16s + (k mod 16).
Rom filled(std::size_t size, std::size_t slice) {
  Rom rom(size);
  for (std::size_t i = 0; i < size; ++i) rom[i] = static_cast<std::uint8_t>(16 * (i / slice) + i % 16);
  return rom;
}

void expect(Bench& bench, unsigned address, unsigned value) {
  INFO(std::hex << address);
  CHECK(unsigned{bench.see(address)} == value);
}

unsigned color(Bench& bench, unsigned number) {
  bench.end_step();
  return bench.state.tia.color[number];
}

TEST_CASE("Case 5: E7") {
  Bench bench(filled(16384, 2048), asking_for("E7"));
  bench.see(0x1FE7);
  bench.write_at(0, 0x1010, 0x42);
  expect(bench, 0x1410, 0x42);
  expect(bench, 0x1010, 0x70);
  bench.write_at(0, 0x1810, 0x24);
  expect(bench, 0x1910, 0x24);
  expect(bench, 0x1810, 0x70);
}

Rom dpc_image() {
  Rom rom(10240);
  for (std::size_t i = 0; i < 2048; ++i) rom[8192 + i] = static_cast<std::uint8_t>(i % 256);
  return rom;
}

TEST_CASE("Case 7: DPC") {
  Bench bench(dpc_image());
  REQUIRE(bench.board.slot.scheme.name == "DPC");
  bench.write_at(0, 0x1070, 0);
  for (const unsigned value : {0x03, 0x07, 0x0F, 0x1E, 0x3D, 0x7A, 0xF4, 0xE8}) expect(bench, 0x1000, value);
  bench.write_at(0, 0x1040, 4);
  bench.write_at(0, 0x1048, 2);
  bench.write_at(0, 0x1050, 5);
  bench.write_at(0, 0x1058, 0);
  for (const unsigned value : {0x00, 0xFB, 0xFC, 0x00, 0x00, 0x00}) expect(bench, 0x1010, value);
}

// One voice, top 9, bottom 4: 75.76 cycles a clock; it is high for five clocks, and low for five.
TEST_CASE("DPC: music follows the cycle counter, across frames, and a reset keeps the fetchers") {
  Bench bench(dpc_image());
  bench.write_at(0, 0x1045, 9);
  bench.write_at(0, 0x104D, 4);
  bench.write_at(0, 0x105D, 0x10);
  bench.write_at(0, 0x1055, 0);  // starts at the top
  const auto clock_cycle = [](int clocks) {
    return static_cast<int>(clocks * 1193191.66666667 / 15750.0) + 1;
  };
  for (int clocks = 1; clocks < 40; ++clocks) {
    INFO(clocks);
    const int low = 9 - clocks % 10;
    CHECK(int{bench.see(0x1004, clock_cycle(clocks))} == (low > 4 ? 4 : 0));
  }
  bench.next_frame(clock_cycle(40));
  for (int clocks = 41; clocks < 60; ++clocks) {
    const int low = 9 - clocks % 10;
    CHECK(int{bench.see(0x1004, clock_cycle(clocks) - clock_cycle(40))} == (low > 4 ? 4 : 0));
  }
  const auto before = bench.state.cartridge.ram;
  bench.board.slot.scheme.reset(bench.board.slot);
  CHECK(std::equal(before.begin() + 8, before.begin() + 64, bench.state.cartridge.ram.begin() + 8));
}

TEST_CASE("DPC: opcode fetches from the hot page clock the random number") {
  Rom rom = dpc_image();
  for (const unsigned bank : {0U, 4096U}) {
    const std::uint8_t code[] = {0xEA, 0xAD, 0x00, 0x10};  // $1FD0: NOP; LDA $1000
    std::copy(std::begin(code), std::end(code), rom.begin() + bank + 0xFD0);
  }
  Bench bench(rom);
  bench.write_at(0, 0x1070, 0);
  bench.cpu.PC = 0x1FD0;
  bench.run_program(2);
  CHECK(int{bench.cpu.A} == 0x3D);  // five accesses: 03 07 0F 1E 3D
}

TEST_CASE("UA selects at $0220 and $0240, which are the TIA's too") {
  Bench bench(filled(8192, 4096), asking_for("UA"));
  expect(bench, 0x1005, 0x05);
  for (const unsigned high : {0U, 0x2000U, 0xE000U})
    for (const bool by_write : {false, true})
      for (const unsigned bank : {1U, 0U}) {
        const unsigned address = (bank ? 0x0240 : 0x0220) + high;
        if (by_write)
          bench.write_at(3, address, 0x1E);
        else
          bench.see(address);
        expect(bench, 0x1005, 16 * bank + 5);
      }
  for (const unsigned beside : {0x0221U, 0x0241U, 0x0020U, 0x0040U, 0x0260U, 0x1240U}) {
    bench.see(beside);
    bench.write_at(3, beside, 0);
    expect(bench, 0x1005, 0x05);
  }
  bench.write_at(6, 0x0209, 0x2E);
  CHECK(color(bench, 3) == 0x2E);
}

TEST_CASE("3E: writes reach the TIA but those that are stored in RAM; MC: no write to its page does") {
  Bench bench(filled(8192, 2048), asking_for("3E"));
  bench.write_at(3, 0x09, 0x12);
  CHECK(color(bench, 3) == 0x12);
  bench.write_at(3, 0x1409, 0x34);
  CHECK(color(bench, 3) == 0x34);
  bench.write_at(3, 0x3E, 1);
  bench.write_at(3, 0x1409, 0x56);
  CHECK(color(bench, 3) == 0x34);
  expect(bench, 0x1009, 0x56);
  expect(bench, 0x0009, 0x56);

  Bench megacart(Rom(131072), asking_for("MC"));
  megacart.write_at(3, 0x49, 0x12);
  CHECK(color(megacart, 3) == 0x12);
  megacart.write_at(3, 0x09, 0x34);
  megacart.write_at(3, 0x1009, 0x34);
  CHECK(color(megacart, 3) == 0x12);
}

TEST_CASE("F8 swapped starts in its first bank") {
  Bench swapped(filled(8192, 4096), asking_for("F8 swapped"));
  expect(swapped, 0x1005, 0x05);
  expect(swapped, 0x1FF9, 0x19);
}

// A load of two pages, to banks 0 and 1, and its start address.
Rom ar_image(unsigned number) {
  Rom rom(8448);
  for (std::size_t i = 0; i < 512; ++i) rom[i] = static_cast<std::uint8_t>(i * 3 + 1);
  const std::uint8_t header[] = {0x34, 0xF2, 0x1C, 2, 0, static_cast<std::uint8_t>(number)};
  std::copy(std::begin(header), std::end(header), rom.begin() + 8192);
  rom[8192 + 16] = 0 | 3 << 2;
  rom[8192 + 17] = 1 | 7 << 2;
  return rom;
}

TEST_CASE("AR: a read of $1850 loads what RAM $80 asks for") {
  Bench bench(ar_image(5), asking_for("AR"));
  bench.state.riot.ram[0] = 4;
  bench.see(0x1850);
  CHECK(int{bench.state.riot.ram[0]} == 4);  // load 4 does not exist
  bench.state.riot.ram[0] = 5;
  bench.see(0x1850);
  CHECK(int{bench.state.riot.ram[0x7E]} == 0x34);
  CHECK(int{bench.state.riot.ram[0x7F]} == 0xF2);
  CHECK(int{bench.state.riot.ram[0]} == 0x1C);
  bench.see(0x101C);
  bench.see(0x1FF8);  // configuration 7: banks 1 and 2
  expect(bench, 0x1700 + 9, (256 + 9) * 3 % 256 + 1);
  bench.see(0x1004);
  bench.see(0x1FF8);  // configuration 1: bank 0 and the BIOS
  expect(bench, 0x1300 + 9, 9 * 3 + 1);
}

TEST_CASE("AR: the BIOS starts load 0 at its address, under its configuration") {
  Rom rom = ar_image(0);
  rom[8192] = 0x02;
  rom[8192 + 1] = 0xF7;
  Bench bench(rom, asking_for("AR"));
  int steps = 0;
  while (bench.cpu.PC != 0xF702 && ++steps < 2000) bench.run_program(1);
  CHECK(int{bench.cpu.PC} == 0xF702);
  expect(bench, 0x1700 + 9, (256 + 9) * 3 % 256 + 1);
  CHECK(int{bench.state.cartridge.bank[0]} == 0x1C);
}

TEST_CASE("AR: BRK leads to where a reset does, as in the reference") {
  Bench bench(ar_image(0), asking_for("AR"));
  bench.see(0x1004);
  bench.see(0x1FF8);  // configuration 1: bank 0 and the BIOS
  std::uint16_t place = 0x1FFA;
  for (const int byte : {0x02, 0x02, 0x0A, 0xF8, 0x0A, 0xF8}) expect(bench, place++, byte);
}

struct RamScheme {
  const char* name;
  std::size_t size;
  std::uint32_t ram;  // draws a reset takes
};

TEST_CASE("A reset fills a cartridge's RAM, one draw a byte; CV with contents takes no draw") {
  constexpr RamScheme kRamSchemes[] = {{"FASC", 12288, 256},  {"E7", 16384, 2048}, {"3E", 8192, 32768},
                                       {"CV", 2048, 1024},    {"CV 4K", 4096, 0},  {"AR", 8448, 6144},
                                       {"MC", 131072, 32768}, {"DPC", 10240, 0}};
  for (const RamScheme& scheme : kRamSchemes) {
    INFO(scheme.name);
    SystemGenerator generator(4753849);
    Console console(std::make_shared<Rom>(filled(scheme.size, 2048)), asking_for(scheme.name), generator);
    CHECK(console.state().drawn == 129 + 1 + scheme.ram);
    const std::vector<std::uint8_t> before(console.cartridge_ram().begin(), console.cartridge_ram().end());
    console.reset();
    CHECK(console.state().drawn == 129 + 2 * (1 + scheme.ram));
    CHECK(std::ranges::equal(before, console.cartridge_ram()) == (scheme.ram <= 256));
  }
}

TEST_CASE("A console takes only as much cartridge RAM as it has") {
  SystemGenerator generator(4753849);
  Console console(std::make_shared<Rom>(filled(16384, 2048)), asking_for("E7"), generator);
  const State state = console.state();
  std::vector<std::uint8_t> ram(console.cartridge_ram().begin(), console.cartridge_ram().end());
  REQUIRE(ram.size() == 2048);
  ram[7] ^= 0xFF;
  console.restore(state, ram);
  CHECK(std::ranges::equal(ram, console.cartridge_ram()));
  CHECK_THROWS_WITH(console.restore(state), Catch::Contains("0 bytes") && Catch::Contains("2048"));
  CHECK(std::ranges::equal(ram, console.cartridge_ram()));
}

TEST_CASE("Code runs from RAM on the cartridge, and sees what it writes there") {
  struct Place {
    const char* name;
    std::size_t size;
    unsigned select, write_port, read_port;
  };
  for (const Place& place : {Place{"E7", 16384, 0x1FE7, 0x1000, 0x1400},
                             {"E7", 16384, 0x1FE9, 0x1800, 0x1900},
                             {"3E", 8192, 0x3E, 0x1400, 0x1000},
                             {"CV", 2048, 0x1FFF, 0x1400, 0x1000},
                             {"FASC", 12288, 0x1FF9, 0x1000, 0x1100},
                             {"MC", 131072, 0x3C, 0x1000, 0x1200}}) {
    INFO(place.name);
    Bench bench(Rom(place.size), asking_for(place.name));
    bench.write_at(0, place.select, 2);
    // LDA #$5A; STA write+6; LDX #$00, whose operand is the byte that has just been stored
    const unsigned own = place.write_port + 6;
    const unsigned code[] = {0xA9, 0x5A, 0x8D, own & 0xFF, own >> 8, 0xA2, 0x00};
    for (unsigned i = 0; i < std::size(code); ++i) bench.write_at(0, place.write_port + i, code[i]);
    bench.cpu.PC = static_cast<std::uint16_t>(place.read_port);
    bench.run_program(3);
    CHECK(int{bench.cpu.X} == 0x5A);
  }
}

}  // namespace
}  // namespace racebeam::test

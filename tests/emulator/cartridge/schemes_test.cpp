// Each cartridge scheme: mapping, hot spots by read and by write, RAM, and resets (docs/spec/cartridges.md, 4
// to 7; docs/spec/cartridges.md, "How to check").
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

// The images of the specification's cases: byte k of slice s is 16s + (k mod 16). For the detection of
// on-board RAM the first 256 bytes of each bank are all 16s + 3.
Rom filled(std::size_t size, std::size_t slice, bool ram_ports = false) {
  Rom rom(size);
  for (std::size_t i = 0; i < size; ++i)
    rom[i] = static_cast<std::uint8_t>(16 * (i / slice) + (ram_ports && i % 4096 < 256 ? 3 : i % 16));
  return rom;
}

Rom patched(Rom rom, std::size_t at, std::initializer_list<std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), rom.begin() + static_cast<long>(at));
  return rom;
}

void expect_scheme(Bench& bench, const std::string& name) {
  REQUIRE(std::string(bench.board.slot.scheme.name) == name);
}

void touch(Bench& bench, unsigned address, bool by_write) {
  if (by_write)
    bench.write_at(0, address, 0xFF);
  else
    bench.see(address);
}

TEST_CASE("2K shows twice, 4K once, whatever the three address bits above say") {
  Rom rom(4096);
  for (std::size_t i = 0; i < rom.size(); ++i) rom[i] = static_cast<std::uint8_t>(i * 5 + (i >> 8));
  Bench small(Rom(rom.begin(), rom.begin() + 2048)), large(rom);
  expect_scheme(small, "2K");
  expect_scheme(large, "4K");
  for (unsigned i = 0; i < 4096; i += 37)
    for (const unsigned high : {0x1000U, 0x3000U, 0xD000U, 0xF000U}) {
      CHECK(small.see(high + i) == rom[i % 2048]);
      CHECK(large.see(high + i) == rom[i]);
    }
  large.write_at(0, 0x1234, static_cast<std::uint8_t>(~rom[0x234]));
  CHECK(large.see(0x1234) == rom[0x234]);
}

struct BankScheme {
  const char* name;
  std::size_t size;
  bool ram;
  unsigned hotspot;
  unsigned initial;
  bool writes_switch;
};

constexpr BankScheme kBankSchemes[] = {
    {"F8", 8192, false, 0x1FF8, 1, true},   {"F8SC", 8192, true, 0x1FF8, 1, true},
    {"F6", 16384, false, 0x1FF6, 0, true},  {"F6SC", 16384, true, 0x1FF6, 0, true},
    {"F4", 32768, false, 0x1FF4, 0, true},  {"F4SC", 32768, true, 0x1FF4, 0, false},
    {"EF", 65536, false, 0x1FE0, 1, true},  {"EFSC", 65536, true, 0x1FE0, 15, true},
    {"DF", 131072, false, 0x1FC0, 1, true}, {"DFSC", 131072, true, 0x1FC0, 15, true},
    {"BF", 262144, false, 0x1F80, 1, true}, {"BFSC", 262144, true, 0x1F80, 15, true},
};

// Each bank has its number in the bytes from $F00 on.
Rom banked_image(const BankScheme& scheme) {
  Rom rom = filled(scheme.size, 4096, scheme.ram);
  for (std::size_t bank = 0; bank < scheme.size / 4096; ++bank)
    std::fill_n(rom.begin() + static_cast<long>(4096 * bank + 0xF00), 0x80, bank);
  return rom;
}

Bench bench_of(const BankScheme& scheme, Rom rom) {
  Properties properties = ntsc();
  properties.scheme = scheme.name;
  return Bench(std::move(rom), properties);
}

Bench bench_of(const BankScheme& scheme) { return bench_of(scheme, banked_image(scheme)); }

void check_bank(Bench& bench, const Rom& rom, unsigned bank) {
  for (unsigned offset = 0x100; offset < 0xF80; offset += 61)
    REQUIRE(int{bench.see(0x1000 + offset)} == int{rom[bank * 4096 + offset]});
  REQUIRE(unsigned{bench.see(0x1F10)} == bank);
}

TEST_CASE("Schemes of Atari's kind switch banks at their hot spots, and a read gets the new bank's byte") {
  for (const BankScheme& scheme : kBankSchemes) {
    INFO(scheme.name);
    const Rom rom = banked_image(scheme);
    Bench bench = bench_of(scheme);
    expect_scheme(bench, scheme.name);
    const unsigned banks = static_cast<unsigned>(scheme.size / 4096);
    check_bank(bench, rom, scheme.initial);
    for (unsigned turn = 0; turn < 3 * banks; ++turn) {
      const unsigned bank = turn * 5 % banks, address = scheme.hotspot + bank;
      CHECK(bench.see(0xE000 | address) == rom[bank * 4096 + (address & 0xFFF)]);
      check_bank(bench, rom, bank);
      touch(bench, scheme.hotspot + (bank + 1) % banks, true);
      check_bank(bench, rom, scheme.writes_switch ? (bank + 1) % banks : bank);
    }
    // The addresses next to the hot spots have no effect.
    touch(bench, scheme.hotspot, false);
    for (const unsigned beside : {scheme.hotspot - 1, scheme.hotspot + banks}) {
      touch(bench, beside, false);
      touch(bench, beside, true);
      check_bank(bench, rom, 0);
    }
  }
}

TEST_CASE("On-board RAM is written at one port and read at the other") {
  for (const BankScheme& scheme : kBankSchemes) {
    if (!scheme.ram) continue;
    INFO(scheme.name);
    const Rom rom = banked_image(scheme);
    Bench bench = bench_of(scheme);
    for (unsigned i = 0; i < 128; ++i) bench.write_at(0, 0x1000 + i, 200 - i);
    for (unsigned i = 0; i < 128; ++i) {
      CHECK(int{bench.see(0x1000 + i)} ==
            int{rom[scheme.initial * 4096 + i]});  // reading the write port changes nothing
      CHECK(bench.see(0x1080 + i) == 200 - i);
      bench.write_at(0, 0x1080 + i, 1);  // nor does writing the read port
      CHECK(bench.see(0x1080 + i) == 200 - i);
    }
    touch(bench, scheme.hotspot + 1, false);
    CHECK(bench.see(0x10FF) == 73);  // every bank has the same RAM
  }
}

TEST_CASE("A reset selects the first bank and fills the RAM anew from the generator") {
  for (const BankScheme& scheme : kBankSchemes) {
    INFO(scheme.name);
    SystemGenerator generator(4753849);
    Properties properties = ntsc();
    properties.scheme = scheme.name;
    Console console(std::make_shared<Rom>(banked_image(scheme)), properties, generator);
    const std::uint32_t draws = scheme.ram ? 129 : 1;
    CHECK(console.state().drawn == 129 + draws);
    const State before = console.state();
    console.reset();
    CHECK(console.state().drawn == 129 + 2 * draws);
    CHECK(unsigned{console.peek(0x1F10)} == scheme.initial);
    CHECK((before.cartridge.ram != console.state().cartridge.ram) == scheme.ram);
  }
}

TEST_CASE("A reset passes over banks that end with filling, unless all do") {
  for (const BankScheme& scheme : kBankSchemes)
    for (const int filling : {0x00, 0xFF}) {
      INFO(scheme.name << " " << filling);
      const auto banks = static_cast<unsigned>(scheme.size / 4096);
      Rom rom = banked_image(scheme);
      for (unsigned turn = 0; turn < banks; ++turn) {
        Bench bench = bench_of(scheme, rom);
        CHECK(unsigned{bench.see(0x1F10)} == (scheme.initial + turn) % banks);
        const unsigned end = ((scheme.initial + turn) % banks + 1) * 4096;
        std::fill_n(rom.begin() + end - 4, 4, filling);
      }
      Bench bench = bench_of(scheme, rom);
      CHECK(unsigned{bench.see(0x1F10)} == scheme.initial);
    }
}

TEST_CASE("Case 3: F8SC") {
  const Rom rom = filled(8192, 4096, true);
  SystemGenerator generator(4753849);
  Console console(std::make_shared<Rom>(rom), ntsc(), generator);
  const int first[] = {0xC3, 0x39, 0x1D, 0x72};
  for (unsigned i = 0; i < 4; ++i)
    CHECK(int{console.peek(static_cast<std::uint16_t>(0x1080 + i))} == first[i]);
  Bench bench(rom);
  CHECK(int{bench.see(0x1105)} == 0x15);
  bench.write_at(0, 0x1FF8, 0);
  CHECK(int{bench.see(0x1105)} == 0x05);
  CHECK(int{bench.see(0x1FF9)} == 0x19);
}

TEST_CASE("Case 4: F4SC switches on reads only") {
  Bench bench(filled(32768, 4096, true));
  bench.see(0x1FF6);
  CHECK(int{bench.see(0x1205)} == 0x25);
  bench.write_at(0, 0x1FF4, 0);
  CHECK(int{bench.see(0x1205)} == 0x25);
  bench.write_at(0, 0x1003, 0x99);
  CHECK(int{bench.see(0x1083)} == 0x99);
  CHECK(int{bench.see(0x1003)} == 0x23);
}

Rom e0_image() { return patched(filled(8192, 1024), 0x100, {0x8D, 0xE0, 0x1F}); }

void check_e0(Bench& bench, const std::array<unsigned, 4>& slices) {
  for (unsigned window = 0; window < 4; ++window)
    CHECK(int{bench.see(0x1000 + 0x400 * window + 0x205)} == static_cast<int>(16 * slices[window] + 5));
}

TEST_CASE("E0 shows any slice in three windows, and the last slice in the fourth") {
  for (const bool by_write : {false, true}) {
    Bench bench(e0_image());
    expect_scheme(bench, "E0");
    std::array<unsigned, 4> slices = {4, 5, 6, 7};
    check_e0(bench, slices);
    for (unsigned i = 0; i < 24; ++i) {
      const unsigned hotspot = i * 7 % 24;
      touch(bench, 0x1FE0 + hotspot, by_write);
      slices[hotspot / 8] = hotspot % 8;
      check_e0(bench, slices);
    }
    for (const unsigned beside : {0x1FDFU, 0x1FF8U}) {
      touch(bench, beside, by_write);
      check_e0(bench, slices);
    }
    CHECK(int{bench.see(0x1FE4)} == 0x74);  // a hot spot reads as slice 7
  }
  SystemGenerator generator(4753849);
  Console console(std::make_shared<Rom>(e0_image()), ntsc(), generator);
  CHECK(int{console.peek(0x1205)} == 0x45);
  CHECK(int{console.peek(0x1E05)} == 0x75);
}

TEST_CASE("FE shows the half that bit 13 of the address asks for") {
  Bench bench(patched(filled(8192, 4096), 0x100, {0x20, 0x00, 0xD0, 0xC6, 0xC5}));
  expect_scheme(bench, "FE");
  for (const unsigned high : {0xF000U, 0x3000U, 0xB000U}) CHECK(int{bench.see(high + 0x205)} == 0x05);
  for (const unsigned high : {0xD000U, 0x1000U, 0x9000U}) CHECK(int{bench.see(high + 0x205)} == 0x15);
  for (const unsigned address : {0x01FEU, 0x1FF8U, 0xFFF8U, 0xFFF9U}) touch(bench, address, true);
  CHECK(int{bench.see(0xF205)} == 0x05);
}

Rom image_3f(std::size_t size = 8192) {
  return patched(patched(filled(size, 2048), 0x100, {0x85, 0x3F}), 0x110, {0x85, 0x3F});
}

unsigned colubk(Bench& bench) {
  bench.end_step();
  const unsigned color = bench.state.tia.color[3];
  return color;
}

TEST_CASE("Case 6: 3F owns the first 64 addresses") {
  Bench bench(image_3f());
  expect_scheme(bench, "3F");
  bench.write_at(0, 0x3F, 0x02);
  CHECK(int{bench.see(0x1005)} == 0x25);
  CHECK(int{bench.see(0x0C)} == 0x2C);
  bench.write_at(3, 0x09, 0x03);
  CHECK(int{bench.see(0x1005)} == 0x35);
  CHECK(colubk(bench) == 0x02);
  bench.write_at(6, 0x1849, 0x1C);
  CHECK(colubk(bench) == 0x1C);
  CHECK(int{bench.see(0x1005)} == 0x35);
}

TEST_CASE("3F: the last bank is fixed, numbers wrap, the mirrors of the TIA are the TIA") {
  Bench bench(image_3f());
  for (unsigned bank = 0; bank < 20; ++bank) {
    bench.write_at(0, bank % 0x40, bank);
    CHECK(int{bench.see(0x1005)} == static_cast<int>(16 * (bank % 4) + 5));
    CHECK(int{bench.see(0x1805)} == 0x35);
    CHECK(int{bench.see(0x2005)} == static_cast<int>(16 * (bank % 4) + 5));  // 13 address bits count
  }
  bench.write_at(3, 0x49, 0x5A);  // COLUBK by its mirror: no bank
  CHECK(colubk(bench) == 0x5A);
  CHECK(int{bench.see(0x1005)} == 0x35);
  CHECK((bench.see(0x4C, 6) & 0x80) == 0x80);  // INPT4
  bench.write_at(9, 0x1009, 0x01);             // the cartridge's copy of the hot spots
  CHECK(int{bench.see(0x1005)} == 0x15);
  CHECK(colubk(bench) == 0x00);
  SystemGenerator generator(4753849);
  Console console(std::make_shared<Rom>(image_3f()), ntsc(), generator);
  CHECK(int{console.peek(0x1005)} == 0x05);
}

TEST_CASE("3F and 3E: of an image that ends within a bank, that bank is selected, and the last 2K stay") {
  const Rom rom = image_3f(5000);  // the third bank has 904 bytes, and the last 2K begin at 2952
  for (const std::string_view scheme : {"3F", "3E"}) {
    INFO(scheme);
    Bench bench(rom, {.scheme = std::string(scheme)});
    for (const auto& [value, bank] : {std::pair(0, 0), {1, 1}, {2, 2}, {3, 1}, {4, 0}, {255, 1}}) {
      bench.write_at(0, 0x3F, static_cast<unsigned>(value));
      CHECK(int{bench.see(0x1005)} == 16 * bank + 5);
      CHECK(int{bench.see(0x1805)} == rom[2957]);
      CHECK(int{bench.see(0x1FFF)} == rom[4999]);
    }
    bench.write_at(0, 0x3F, 2);
    CHECK(int{bench.see(0x05)} == 0x25);
    CHECK(int{bench.see(0x1387)} == rom[4999]);
    CHECK(int{bench.see(0x1388)} == 0);
    CHECK(int{bench.see(0x17FF)} == 0);
    bench.write_at(0, 0x3F, 0);
    CHECK(int{bench.see(0x17FF)} == rom[2047]);
  }
}

TEST_CASE("3F: a bank of fewer than 64 bytes is read, and a state may have it") {
  const Rom rom = image_3f(4096 + 63);
  Bench bench(rom, {.scheme = "3F"});
  bench.write_at(0, 0x3F, 2);
  CHECK(int{bench.see(0x103E)} == rom[4096 + 62]);
  CHECK(int{bench.see(0x103F)} == 0);
  CHECK(int{bench.see(0x1800)} == rom[2048 + 63]);
}

}  // namespace
}  // namespace racebeam::test

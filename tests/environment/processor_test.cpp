// The interpreter and the translator give the same output. saved_state_fuzz_test.cpp tests the same for
// altered states.
#include <algorithm>
#include <catch2/catch.hpp>
#include <list>

#include "games/catalogue.hpp"
#include "games/md5.hpp"
#include "tests/environment/steered.hpp"
#include "tests/support/random_image.hpp"

namespace racebeam {
namespace {

Settings running_on(CpuKind cpu) {
  Settings settings = test::plain();
  settings.cpu = cpu;
  return settings;
}

bool show_the_same(const Environment& one, const Environment& other) {
  return std::ranges::equal(one.screen(), other.screen()) && std::ranges::equal(one.ram(), other.ram());
}

using Code = std::vector<std::uint8_t>;

constexpr std::size_t kResult = 1;  // index of the RAM for results of the programs

// LDA #2, VSYNC on, two lines, off; JMP to the start.
Code with_frame(Code code, std::uint8_t page) {
  for (const int byte : {0xA9, 2, 0x85, 0, 0x85, 2, 0x85, 2, 0xA9, 0, 0x85, 0, 0x4C, 0, int{page}})
    code.push_back(static_cast<std::uint8_t>(byte));
  return code;
}

std::shared_ptr<const Image> image_of(Code bytes) {
  auto image = std::make_shared<Image>();
  image->md5 = md5_of(bytes);
  image->bytes = std::make_shared<const Code>(std::move(bytes));
  return image;
}

// LDA $0C reads the fire button in most schemes, but the cartridge in some.
std::shared_ptr<const Image> image_reading_low_page() {
  Code code = with_frame({0xA5, 0x0C, 0x85, 0x80 + kResult}, 0xF8);
  code.resize(2048);
  code[2045] = 0xF8;  // the reset vector
  return image_of(std::move(code));
}

// One image under each scheme. All machines exist at once, and share what can be shared.
TEST_CASE("An image that runs under several schemes at once shows what it shows interpreted") {
  const auto image = image_reading_low_page();
  struct Two {
    Environment interpreted, translated;
  };
  std::list<Two> machines;
  for (const char* scheme : {"2K", "3F", "3E", "CV"}) {
    const auto game = test::random_game(scheme);
    machines.push_back(
        {{image, game, running_on(CpuKind::kInterpreter)}, {image, game, running_on(CpuKind::kAuto)}});
  }
  for (int act = 0; act < 5; ++act)
    for (auto& [interpreted, translated] : machines) {
      interpreted.act(act);
      translated.act(act);
      REQUIRE(show_the_same(interpreted, translated));
    }
  const auto result = [](const Two& two) { return two.translated.ram()[kResult]; };
  CHECK(result(machines.front()) != result(*std::next(machines.begin())));
}

// Each frame starts in bank 1, goes to bank 0 by this read within straight code, stores 1 + the bank, and
// goes back.
std::shared_ptr<const Image> ua_image(Code code) {
  const std::size_t bank_at = code.size() + 1;
  // LDA #1 + bank, STA, LDA $0240
  for (const int byte : {0xA9, 0, 0x85, 0x80 + int{kResult}, 0xAD, 0x40, 0x02})
    code.push_back(static_cast<std::uint8_t>(byte));
  code = with_frame(std::move(code), 0xF0);
  Code bytes(8192);
  for (const std::size_t bank : {0U, 1U}) {
    code[bank_at] = static_cast<std::uint8_t>(bank + 1);
    std::ranges::copy(code, bytes.begin() + static_cast<std::ptrdiff_t>(4096 * bank));
    bytes[4096 * bank + 4093] = 0xF0;  // the reset vector
  }
  return image_of(std::move(bytes));
}

TEST_CASE("A read that switches UA's banks takes effect at once") {
  const std::vector<Code> reads = {{0xAD, 0x20, 0x02},               // LDA $0220
                                   {0x2C, 0x20, 0x02},               // BIT
                                   {0xA2, 0x20, 0xBD, 0x00, 0x02},   // LDX #$20, LDA $0200,X
                                   {0xA0, 0x30, 0xB9, 0xF0, 0x01}};  // LDY #$30, LDA $01F0,Y: across a page
  for (const Code& read : reads)
    for (const CpuKind cpu : {CpuKind::kInterpreter, CpuKind::kAuto}) {
      INFO("opcode " << int{read[0]} << ", processor " << static_cast<int>(cpu));
      Environment environment(ua_image(read), test::random_game("UA"), running_on(cpu));
      for (int act = 0; act < 5; ++act) environment.act(0);
      CHECK(int{environment.ram()[kResult]} == 1);
    }
}

// Fills RAM with a program, apart from the two bytes given, and runs it. It takes each 25th instruction from
// $007F, where the bits of the opcode are those on the bus: $1A, NOP, which the branch to it left there. Each
// time that it is $38, SEC, the program counts at $E0. The step's 25,000 instructions end before it.
std::shared_ptr<const Image> image_in_tia(std::uint8_t address, std::uint8_t value) {
  Code bytes(4096, 0xEA);
  const Code boot = {0xA2, 0x7F, 0xBD, 0x00, 0xF2, 0x95, 0x80, 0xCA, 0x10, 0xF8, 0xA9, 0x00, 0xA2,
                     0xFF, 0x9A, 0xA0, 0x00, 0x18, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA, 0xEA};
  Code loop = {0xA5, 0xE0, 0x69, 0x00, 0x85, 0xE0, 0x18};  // $E0 += carry
  for (int i = 0; i < 8; ++i) loop.insert(loop.end(), {0xA9, 0x00});
  loop.resize(loop.size() + 10, 0xEA);
  loop.insert(loop.end(), {0xA9, 0x00, 0x10, 0xDA});  // LDA #0; BPL $007F
  std::ranges::copy(boot, bytes.begin());
  std::ranges::copy(Code{0x4C, 0x80, 0x00}, bytes.begin() + static_cast<std::ptrdiff_t>(boot.size()));
  const auto ram = bytes.begin() + 0x200;
  std::fill(ram, ram + 128, std::uint8_t{0x18});
  std::ranges::copy(loop, ram);
  ram[0x60] = 0;
  ram[address - 0x80] = value;
  bytes[0xFFD] = 0xF0, bytes[0xFFC] = 0x00;
  return image_of(std::move(bytes));
}

// The numbers are ALE's. Its agent reads all RAM after each act and each group of frames of a reset; within a
// group, the rule of Pitfall II reads $C7 last.
TEST_CASE("Code in the TIA finds on the bus what was accessed last, at the end of a frame too") {
  const auto game = find_game("pitfall2");
  const auto counts = [&](std::uint8_t address, CpuKind cpu) {
    Environment environment(image_in_tia(address, 0x38), game, running_on(cpu));
    std::vector<int> found;
    for (int act = 0; act < 3; ++act) {
      found.push_back(environment.ram()[0x60]);
      environment.act(0);
    }
    return found;
  };
  for (const CpuKind cpu : {CpuKind::kInterpreter, CpuKind::kAuto}) {
    CHECK(counts(0xFF, cpu) == std::vector{3, 4, 5});
    CHECK(counts(0xC7, cpu) == std::vector{65, 65, 65});
    CHECK(counts(0xC8, cpu) == std::vector{0, 0, 0});
  }
}

}  // namespace
}  // namespace racebeam

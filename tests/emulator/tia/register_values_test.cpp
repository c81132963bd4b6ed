// The values of the TIA's registers, as a program has written them.
#include "emulator/tia/registers/register_values.hpp"

#include <catch2/catch.hpp>

#include "emulator/console.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A program that writes a value into each register from VBLANK to RESMP1, but for the strobes of positions,
// once in a frame. Before, it strobes RESP0 and RESBL at different places of a line.
Bytes writer(std::uint8_t value) {
  Bytes program = {0xA9, 0x02, 0x85, VSYNC, 0x85, WSYNC, 0x85, WSYNC, 0x85, WSYNC, 0xA9, 0x00, 0x85, VSYNC};
  for (int nops = 0; nops < 15; ++nops) program.push_back(0xEA);
  program.insert(program.end(), {0x85, RESP0, 0xEA, 0xEA, 0x85, RESBL, 0xA9, value});
  for (std::uint8_t reg = NUSIZ0; reg <= RESMP1; ++reg)
    if (reg < RESP0 || reg > RESBL) program.insert(program.end(), {0x85, reg});
  program.insert(program.end(), {0xA2, 0xFA, 0x85, WSYNC, 0xCA, 0xD0, 0xFB});  // 250 lines
  program.insert(program.end(), {0x4C, 0x00, 0xF0});
  return program;
}

std::shared_ptr<const Rom> image_of(const Bytes& program) {
  auto rom = std::make_shared<Rom>(4096, std::uint8_t{0xEA});
  std::copy(program.begin(), program.end(), rom->begin());
  (*rom)[0xFFC] = 0x00;
  (*rom)[0xFFD] = 0xF0;
  return rom;
}

std::array<std::uint8_t, kTiaValues> values_after(std::uint8_t value) {
  SystemGenerator generator{4753849};
  Console console(image_of(writer(value)), ntsc(), generator);
  for (int frame = 0; frame < 3; ++frame) console.step();
  return tia_values(console.state(), console.sound());
}

// The bits that the TIA keeps, from NUSIZ0 to RESMP1 (docs/spec/tia.md, 4).
std::uint8_t kept_bits(std::size_t reg) {
  switch (reg) {
    case NUSIZ0:
    case NUSIZ1:
    case CTRLPF: return 0x37;
    case COLUP0:
    case COLUP1:
    case COLUPF:
    case COLUBK: return 0xFE;
    case REFP0:
    case REFP1: return 0x08;
    case ENAM0:
    case ENAM1:
    case ENABL:
    case RESMP0:
    case RESMP1: return 0x02;
    case HMP0:
    case HMP1:
    case HMM0:
    case HMM1:
    case HMBL: return 0xF0;
    case VDELP0:
    case VDELP1:
    case VDELBL: return 0x01;
    default: return 0xFF;
  }
}

}  // namespace

TEST_CASE("The registers of the TIA have the values that a program has written") {
  for (const std::uint8_t value : std::array<std::uint8_t, 4>{0xFF, 0x00, 0xA5, 0x5A}) {
    const auto found = values_after(value);
    for (std::size_t reg = NUSIZ0; reg <= RESMP1; ++reg) {
      if (reg >= RESP0 && reg <= RESBL) continue;
      INFO(kTiaValueNames[reg]);
      CHECK(found[reg] == (value & kept_bits(reg)));
    }
    for (const std::size_t strobe : {WSYNC, RSYNC, HMOVE, HMCLR, CXCLR}) CHECK(found[strobe] == 0);
    CHECK(found[RESBL] != found[RESP0]);
    CHECK(found[RESBL] < 160);
    CHECK(found[RESP0] < 160);
  }
}

TEST_CASE("The collision latches have the bits of the registers that a program reads") {
  const auto of = [](const auto& values, std::string_view name) {
    return values[static_cast<std::size_t>(std::ranges::find(kTiaValueNames, name) - kTiaValueNames.begin())];
  };
  const auto all = values_after(0xFD);  // the missiles are off, and the playfield is everywhere
  CHECK(of(all, "CXP0FB") == 0x80);     // player 0 and the playfield
  CHECK(of(all, "CXM0FB") == 0);
  CHECK(of(all, "CXM0P") == 0);
  const auto none = values_after(0);
  for (std::size_t latch = kTiaRegisters; latch < kTiaValues; ++latch) CHECK(none[latch] == 0);
}

}  // namespace racebeam::test

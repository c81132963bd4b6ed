// What Unicorn does not show of the ARM: unaligned numbers, addresses without memory, faults, and the limit
// of instructions (docs/spec/cartridges.md, 13). compare_with_unicorn.py compares the rest.
#include "emulator/cartridge/arm/thumb.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <vector>

#include "tests/support/thumb_code.hpp"

namespace racebeam::test {
namespace {

using arm::Ending;
using namespace thumb;

constexpr std::uint32_t kRam = arm::kRamBegin, kStart = 0x4000;

struct Chip {
  explicit Chip(std::initializer_list<Code> program, std::size_t flash_size = 0x8000)
      : flash(flash_size), ram(8192) {
    put(flash, kStart + flash_size - arm::kFlashEnd, program);
    registers.r[arm::kPc] = kStart;
    registers.r[arm::kSp] = kRam + 0x1000;
    registers.r[arm::kLr] = kRam;
  }

  Ending run(std::uint32_t instructions = 100) {
    left = instructions;
    return arm::run({flash, ram}, registers, left);
  }
  std::uint32_t& operator[](unsigned number) { return registers.r[number]; }
  std::uint32_t word(std::size_t at) const {
    std::uint32_t number = 0;
    std::memcpy(&number, &ram[at], sizeof number);
    return number;
  }
  void set_word(std::size_t at, std::uint32_t number) { std::memcpy(&ram[at], &number, sizeof number); }

  std::vector<std::uint8_t> flash, ram;
  arm::Registers registers;
  std::uint32_t left = 0;
};

TEST_CASE("A word at an unaligned address is loaded rotated, and stored at the aligned one") {
  const std::uint32_t rotated[] = {0x44332211, 0x11443322, 0x22114433, 0x33221144};
  for (std::uint32_t low = 0; low < 4; ++low) {
    INFO("address " << low);
    Chip chip({ldr(0, 1, 0), str(2, 1, 4), bx(kLr)});
    chip.set_word(8, 0x44332211);
    chip[1] = kRam + 8 + low;
    chip[2] = 0xA5B6C7D8;
    CHECK(chip.run() == Ending::kReturned);
    CHECK(chip[0] == rotated[low]);
    CHECK(chip.word(12) == 0xA5B6C7D8);
  }
}

TEST_CASE("Halves and lists of words ignore the low bits of their address") {
  Chip chip(
      {ldrh(0, 1, 0), strh(2, 1, 2), ldmia(3, 1 << 4), push(1 << 4, false), pop(1 << 5, false), bx(kLr)});
  chip.set_word(8, 0x44332211);
  chip[1] = kRam + 9;
  chip[2] = 0xA5B6;
  chip[3] = kRam + 8 + 3;
  chip[arm::kSp] = kRam + 0x1002;
  CHECK(chip.run() == Ending::kReturned);
  CHECK(chip[0] == 0x2211);
  CHECK(chip.word(8) == 0xA5B62211);
  CHECK(chip[3] == kRam + 12 + 3);
  CHECK(chip[4] == 0xA5B62211);
  CHECK(chip[5] == chip[4]);
  CHECK(chip.word(0xFFC) == chip[4]);
}

TEST_CASE("Outside of memory, numbers are 0, and nothing is stored; the image cannot be written") {
  for (const std::uint32_t address : {0x8000U, 0x3FFFFFFCU, 0x40002000U, 0xE0028000U, 0xFFFFFFFCU, 0x4010U}) {
    INFO(std::hex << address);
    Chip chip({ldr(0, 1, 0), ldrb(2, 1, 3), str(3, 1, 0), ldr(4, 1, 0), stmia(1, 1 << 3), bx(kLr)});
    const std::vector<std::uint8_t> flash = chip.flash, ram = chip.ram;
    chip[0] = chip[2] = chip[3] = chip[4] = 0x12345678;
    chip[1] = address;
    CHECK(chip.run() == Ending::kReturned);
    CHECK(chip[0] == 0);
    CHECK(chip[2] == 0);
    CHECK(chip[4] == 0);
    CHECK(chip[1] == address + 4);
    CHECK(chip.flash == flash);
    CHECK(chip.ram == ram);
  }
}

TEST_CASE("A short image ends where a long one does; below it, memory is missing") {
  Chip chip({ldr(0, 1, 0), ldrb(2, 3, 0), bx(kLr)}, 29697);
  chip.flash[0] = 0x5A;  // at $0BFF
  chip[1] = 0xBFC;
  chip[3] = 0xBFF;
  CHECK(chip.run() == Ending::kReturned);
  CHECK(chip[0] == 0);  // a word that is not whole
  CHECK(chip[2] == 0x5A);
  Chip outside({}, 29696);
  outside[arm::kPc] = 0xBFE;
  CHECK(outside.run() == Ending::kFault);
}

TEST_CASE("Instructions that an ARMv4T does not have are faults") {
  for (const unsigned bits : {0xDE00U, 0xDEFFU, 0xDF00U, 0xDF12U, 0xB100U, 0xB200U, 0xB600U, 0xB800U, 0xBA00U,
                              0xBE00U, 0xBF00U, 0xE800U, 0xEFFFU, 0x4780U, 0x47F0U}) {
    INFO(std::hex << bits);
    Chip chip({mov_number(0, 7), code(bits), mov_number(0, 8), bx(kLr)});
    CHECK(chip.run() == Ending::kFault);
    CHECK(chip[0] == 7);
  }
}

TEST_CASE("An empty list of registers is a fault, and moves no base") {
  for (const Code one : {push(0, false), pop(0, false), stmia(2, 0), ldmia(2, 0)}) {
    INFO(std::hex << one);
    Chip chip({one, bx(kLr)});
    chip[2] = kRam + 16;
    CHECK(chip.run() == Ending::kFault);
    CHECK(chip[2] == kRam + 16);
    CHECK(chip[arm::kSp] == kRam + 0x1000);
  }
}

TEST_CASE("A base in the list is stored as it was, and keeps what was loaded") {
  Chip chip({stmia(2, 0x0F), ldmia(3, 0x18), bx(kLr)});
  chip[0] = 1, chip[1] = 2, chip[2] = kRam + 32, chip[3] = kRam + 64;
  chip.set_word(64, 0x1111);
  chip.set_word(68, 0x2222);
  CHECK(chip.run() == Ending::kReturned);
  CHECK(chip.word(40) == kRam + 32);
  CHECK(chip[2] == kRam + 48);
  CHECK(chip[3] == 0x1111);
  CHECK(chip[4] == 0x2222);
}

TEST_CASE("POP, MOV and ADD to PC stay in Thumb; BX to an even address returns") {
  Chip chip({pop(1 << 0, true), kForEver, kForEver, kForEver, mov_any(kPc, 1), kForEver, kForEver, kForEver,
             bx(0)});
  chip.set_word(0x1000, 0x20000);
  chip.set_word(0x1004, kStart + 8);  // even
  chip[1] = kStart + 16;
  CHECK(chip.run() == Ending::kReturned);
  CHECK(chip[arm::kSp] == kRam + 0x1008);
  CHECK(chip.left == 96);  // a register in a list counts
}

TEST_CASE("Code runs in RAM, too, and changes itself there") {
  Chip chip({});
  put(chip.ram, 0x100, {strh(1, 0, 4), mov_number(2, 1), mov_number(2, 2), bx(kLr)});
  chip[0] = kRam + 0x100;
  chip[1] = mov_number(2, 9);
  chip[arm::kPc] = kRam + 0x100;
  CHECK(chip.run() == Ending::kReturned);
  CHECK(chip[2] == 9);
}

TEST_CASE("A program that never ends uses up its instructions, and no more") {
  Chip chip({mov_number(0, 1), kForEver});
  CHECK(chip.run(1000) == Ending::kOutOfTime);
  CHECK(chip.left == 0);
  CHECK(chip[arm::kPc] == kStart + 2);
  CHECK(chip.run(0) == Ending::kOutOfTime);
  Chip exact({mov_number(0, 1), bx(kLr)});
  CHECK(exact.run(2) == Ending::kReturned);
  CHECK(exact.left == 0);
}

// For the sanitizers: whatever the code is, it ends.
TEST_CASE("Random code ends") {
  std::mt19937 random(20261126);
  unsigned endings[3] = {};
  for (int trial = 0; trial < 2000; ++trial) {
    Chip chip({}, 29696 + random() % 3073);
    for (std::uint8_t& byte : chip.flash) byte = static_cast<std::uint8_t>(random());
    for (std::uint32_t& number : chip.registers.r)
      number = (random() % 2 != 0 ? kRam : 0) + static_cast<std::uint32_t>(random()) % 0x9000;
    ++endings[static_cast<std::size_t>(chip.run(5000))];
  }
  for (const unsigned count : endings) CHECK(count > 0);
}

}  // namespace
}  // namespace racebeam::test

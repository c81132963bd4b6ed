// EFF: transfers of bytes to its EEPROM and back (docs/spec/cartridges.md, 11).
#include <catch2/catch.hpp>

#include "emulator/cartridge/mappers/savecircuit.hpp"
#include "tests/emulator/bench.hpp"

namespace racebeam::test {
namespace {

constexpr unsigned kWrite = 0xA0, kRead = 0xA1;  // control bytes of page 0

Properties for_eff() {
  Properties properties = ntsc();
  properties.scheme = "EFF";
  return properties;
}

// What the routines of a game do with the two lines.
struct Wire : Bench {
  Wire() : Bench(Rom(65536, 0xAA), for_eff()) {}

  void clock(bool level) { see(level ? 0x1FF1 : 0x1FF0); }
  void data(bool level) { see(level ? 0x1FF3 : 0x1FF2); }
  bool sees() { return (see(0x1FF4) & 1) != 0; }

  void start() {
    data(true), clock(true);
    data(false), clock(false);
  }
  void stop() {
    data(false), clock(true);
    data(true);
  }
  bool exchange(bool bit) {
    data(bit), clock(true);
    const bool seen = sees();
    clock(false);
    return seen;
  }
  bool is_acknowledged(unsigned byte) {
    for (int bit = 7; bit >= 0; --bit) exchange((byte >> bit & 1) != 0);
    return !exchange(true);
  }
  unsigned receive(bool is_last) {
    unsigned byte = 0;
    for (int bit = 0; bit < 8; ++bit) byte = byte << 1 | exchange(true);
    exchange(is_last);
    return byte;
  }
};

TEST_CASE("EFF: bytes that were written are read, in the same page and across its end") {
  Wire wire;
  wire.start();
  CHECK(wire.is_acknowledged(kWrite + 2 * 3));
  CHECK(wire.is_acknowledged(0xFE));
  for (const unsigned byte : {0x12U, 0x80U, 0x5AU}) CHECK(wire.is_acknowledged(byte));
  wire.stop();
  CHECK(unsigned{wire.board.cartridge_ram[0x3FF]} == 0x80);
  CHECK(unsigned{wire.board.cartridge_ram[0x400]} == 0x5A);
  wire.start();
  CHECK(wire.is_acknowledged(kWrite + 2 * 3));
  CHECK(wire.is_acknowledged(0xFE));
  wire.start();
  CHECK(wire.is_acknowledged(kRead + 2 * 3));
  CHECK(wire.receive(false) == 0x12);
  CHECK(wire.receive(false) == 0x80);
  CHECK(wire.receive(true) == 0x5A);
  wire.stop();
  CHECK(wire.sees());
}

TEST_CASE("EFF: an empty EEPROM reads as $FF, and keeps its bytes through a reset") {
  Wire wire;
  const auto first = [&] {
    wire.start();
    CHECK(wire.is_acknowledged(kWrite));
    CHECK(wire.is_acknowledged(0));
    wire.start();
    CHECK(wire.is_acknowledged(kRead));
    return wire.receive(true);
  };
  CHECK(first() == 0xFF);
  wire.start();
  CHECK(wire.is_acknowledged(kWrite));
  CHECK(wire.is_acknowledged(0));
  CHECK(wire.is_acknowledged(7));
  wire.board.slot.scheme.reset(wire.board.slot);
  CHECK(first() == 7);
}

TEST_CASE("EFF: another chip's control byte is not acknowledged, nor is anything behind it") {
  Wire wire;
  wire.start();
  CHECK_FALSE(wire.is_acknowledged(0x50));
  CHECK_FALSE(wire.is_acknowledged(0));
  CHECK_FALSE(wire.is_acknowledged(0x33));
  CHECK(unsigned{wire.board.cartridge_ram[0]} == 0xFF);
}

}  // namespace
}  // namespace racebeam::test

#include "tests/support/counter_image.hpp"

#include <algorithm>

#include "games/files/game_file.hpp"

namespace racebeam::test {
namespace {

constexpr std::uint8_t kProgram[] = {
    0x78, 0xD8,        // F000       SEI, CLD
    0xA2, 0xFF, 0x9A,  // F002       LDX #$FF, TXS
    0xA9, 0x00,        // F005       LDA #0
    0xA2, 0x1F,        // F007       LDX #$1F
    0x95, 0x80,        // F009 clear STA $80,X
    0xCA,              // F00B       DEX
    0x10, 0xFB,        // F00C       BPL clear
    0xA9, 0x02,        // F00E frame LDA #2
    0x85, 0x00,        // F010       STA VSYNC
    0x85, 0x02,        // F012       STA WSYNC
    0x85, 0x02,        // F014       STA WSYNC
    0x85, 0x02,        // F016       STA WSYNC
    0xA9, 0x00,        // F018       LDA #0
    0x85, 0x00,        // F01A       STA VSYNC      the frame closes here
    0xE6, 0x80,        // F01C       INC $80
    0xAD, 0x80, 0x02,  // F01E       LDA SWCHA
    0x85, 0x81,        // F021       STA $81
    0xAD, 0x82, 0x02,  // F023       LDA SWCHB
    0x85, 0x82,        // F026       STA $82
    0x4A,              // F028       LSR            RESET
    0xB0, 0x02,        // F029       BCS +2
    0xE6, 0x86,        // F02B       INC $86
    0x4A,              // F02D       LSR            SELECT
    0xB0, 0x02,        // F02E       BCS +2
    0xE6, 0x85,        // F030       INC $85
    0xA5, 0x0C,        // F032       LDA INPT4
    0x85, 0x83,        // F034       STA $83
    0xA5, 0x0D,        // F036       LDA INPT5
    0x85, 0x84,        // F038       STA $84
    0xA5, 0x80,        // F03A       LDA $80
    0x85, 0x09,        // F03C       STA COLUBK
    0x85, 0x15,        // F03E       STA AUDC0
    0x85, 0x19,        // F040       STA AUDV0
    0xA2, 0xFA,        // F042       LDX #250
    0x85, 0x02,        // F044 line  STA WSYNC
    0xCA,              // F046       DEX
    0xD0, 0xFB,        // F047       BNE line
    0x4C, 0x0E, 0xF0,  // F049       JMP frame
};

}  // namespace

std::shared_ptr<const Image> counter_image() {
  std::vector<std::uint8_t> bytes(4096);
  std::ranges::copy(kProgram, bytes.begin());
  bytes[0xFFD] = 0xF0;  // the reset vector: $F000
  auto image = std::make_shared<Image>();
  image->md5 = md5_of(bytes);
  image->bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  image->stem = "counter";
  return image;
}

std::shared_ptr<const Game> game(const std::string& text, const std::string& name) {
  return std::make_shared<const Game>(parse_game(text, name, name + ".toml"));
}

}  // namespace racebeam::test

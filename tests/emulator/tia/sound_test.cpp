#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "emulator/tia/sound.hpp"
#include "tests/support/crc.hpp"

namespace racebeam {
namespace {

using Block = std::array<std::uint8_t, kSamplesPerBlock>;
enum { kAUDC0 = 0x15, kAUDC1, kAUDF0, kAUDF1, kAUDV0, kAUDV1 };

Block next_block(Sound& sound) {
  Block block;
  sound.generate(block);
  return block;
}

std::string bits(const Block& block) {
  std::string text;
  for (std::size_t i = 0; i < 48; ++i) text += block[i] == 188 ? '1' : block[i] == 128 ? '0' : '?';
  return text;
}

std::vector<int> first(const Block& block, std::size_t count) {
  return {block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count)};
}

struct Waveform {
  std::uint8_t audc;
  const char* bits;
  std::uint32_t crc;
};

constexpr Waveform kWaveforms[] = {
    {0x0, "001111111111111111111111111111111111111111111111", 0xb865f370},
    {0x1, "001001101011110001001101011110001001101011110001", 0x30520000},
    {0x2, "000000000000000000000000000000000000000000000011", 0x321b94d5},
    {0x3, "000000001000011011110111111000000000011000011010", 0x81167d4f},
    {0x4, "001010101010101010101010101010101010101010101010", 0x174b20cd},
    {0x5, "001010101010101010101010101010101010101010101010", 0x174b20cd},
    {0x6, "000000000000000000000000000000000000000000000011", 0x8eedfb32},
    {0x7, "000000001000101011110110100110000011100100010101", 0xdcb0af3b},
    {0x8, "001000010001100001001110010101011000011011110100", 0x207d37a1},
    {0x9, "001000010010110011111000110111010100001001011001", 0x76389985},
    {0xA, "000000000000000000000000000000000000000000000011", 0x93fb470f},
    {0xB, "001111111111111111111111111111111111111111111111", 0xb865f370},
    {0xC, "100011100011100011100011100011100011100011100011", 0x2452f6f1},
    {0xD, "100011100011100011100011100011100011100011100011", 0x2452f6f1},
    {0xE, "000000000000000111111111111100000000000000000000", 0xbc1dd800},
    {0xF, "000111000000111000000111100000000011111100000111", 0x12bc4bc5},
};

TEST_CASE("Each waveform gives the samples of the reference") {
  for (const Waveform& waveform : kWaveforms) {
    INFO("AUDC0 = " << int{waveform.audc});
    Sound sound;
    sound.write(kAUDC0, waveform.audc);
    sound.write(kAUDV0, 15);
    const Block block = next_block(sound);
    CHECK(bits(block) == waveform.bits);
    CHECK(test::crc(block) == waveform.crc);
  }
}

TEST_CASE("The second channel plays the same waveforms") {
  for (const Waveform& waveform : kWaveforms) {
    Sound sound;
    sound.write(kAUDC1, waveform.audc);
    sound.write(kAUDV1, 15);
    CHECK(test::crc(next_block(sound)) == waveform.crc);
  }
}

TEST_CASE("Two channels add up, and a new pitch goes on where the old one stood") {
  Sound sound;
  for (const auto& [reg, value] :
       {std::pair{kAUDC0, 4}, {kAUDF0, 3}, {kAUDV0, 8}, {kAUDC1, 12}, {kAUDF1, 1}, {kAUDV1, 5}}) {
    sound.write(static_cast<unsigned>(reg), static_cast<std::uint8_t>(value));
  }
  const Block start = next_block(sound);
  CHECK(first(start, 16) ==
        std::vector{128, 148, 148, 128, 128, 128, 128, 128, 128, 148, 148, 180, 180, 180, 180, 128});
  CHECK(test::crc(start) == 0x90dcbc35);

  sound.write(kAUDF0, 1);
  const Block after = next_block(sound);
  CHECK(first(after, 12) == std::vector{128, 180, 180, 148, 148, 180, 180, 128, 128, 160, 160, 128});
  CHECK(test::crc(after) == 0x1425e2a1);
}

TEST_CASE("Silence is 128") {
  Sound sound;
  const Block block = next_block(sound);
  CHECK(std::ranges::all_of(block, [](std::uint8_t sample) { return sample == 128; }));
  CHECK(test::crc(block) == 0xa234c12f);
}

TEST_CASE("The bits that a sound register does not have are ignored") {
  Sound plain, noisy;
  for (unsigned reg = kAUDC0; reg <= kAUDV1; ++reg) {
    const std::uint8_t width = reg >= kAUDF0 && reg <= kAUDF1 ? 0x1F : 0x0F;
    plain.write(reg, 0x07);
    noisy.write(reg, static_cast<std::uint8_t>(0x07 | ~width));
  }
  CHECK(next_block(plain) == next_block(noisy));
}

TEST_CASE("A copy of the generator plays on like the original") {
  Sound sound;
  sound.write(kAUDC0, 8);
  sound.write(kAUDF0, 5);
  sound.write(kAUDV0, 15);
  next_block(sound);
  Sound copy = sound;
  CHECK(next_block(copy) == next_block(sound));
}

}  // namespace
}  // namespace racebeam

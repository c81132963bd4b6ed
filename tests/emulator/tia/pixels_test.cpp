// Compares each variant of the code that draws pixels, if this processor supports it, with a pixel-by-pixel
// model.
#include <catch2/catch.hpp>
#include <random>

#include "emulator/tia/line/pixels.hpp"
#include "tests/support/skip.hpp"

namespace racebeam::test {
namespace {

bool covers(const PixelMask& mask, int pixel) {
  return (mask.word[static_cast<std::size_t>(pixel) / 64] >> (pixel % 64) & 1) != 0;
}

// Each bit is set with a probability of 1/16.
std::uint64_t sparse_word(std::mt19937_64& random) {
  std::uint64_t word = random();
  for (int draw = 0; draw < 3; ++draw) word &= random();
  return word;
}

// Dense, sparse, or empty.
PixelMask random_mask(std::mt19937_64& random) {
  PixelMask mask;
  const auto density = random() % 4;
  for (std::uint64_t& word : mask.word)
    word = density == 0 ? 0 : density == 1 ? sparse_word(random) : random();
  mask.word[2] &= 0xFFFFFFFF;
  return mask;
}

// The colour of one pixel, from docs/spec/tia.md, 10.
unsigned color_of(const Line& line, const TiaRegisters& tia, int pixel) {
  const auto shows = [&](Object object) { return covers(line.mask[object], pixel); };
  const bool score = (tia.ctrlpf & 2) != 0, priority = (tia.ctrlpf & 4) != 0, left = pixel < kLinePixels / 2;
  const bool player0 = shows(kP0) || shows(kM0), player1 = shows(kP1) || shows(kM1);
  if (score && (!priority || tia.enabled == object_bit(kPlayfield))) {
    if (player0 || (shows(kPlayfield) && left)) return kColup0;
    if (player1 || shows(kPlayfield)) return kColup1;
    return shows(kBall) ? kColupf : kColubk;
  }
  const bool playfield = shows(kPlayfield) || shows(kBall);
  if (priority && playfield) return kColupf;
  if (player0) return kColup0;
  if (player1) return kColup1;
  return playfield ? kColupf : kColubk;
}

TEST_CASE("All forms of drawing give the same pixels, and touch no others") {
  std::mt19937_64 random(1);
  if (kHasAvx && supported_simd().back() < Simd::kAvx512)
    test::leave_out("forms that this processor can't run");
  for (int round = 0; round < 20000; ++round) {
    Line line;
    TiaRegisters tia;
    for (std::uint8_t& color : tia.color) color = static_cast<std::uint8_t>(random());
    for (unsigned i = 0; i < kObjects; ++i) {
      line.mask[i] = random_mask(random);
      tia.enabled = static_cast<std::uint8_t>(tia.enabled | (line.mask[i].any() ? object_bit(i) : 0));
    }
    tia.ctrlpf = random() & 7;
    if (random() % 4 == 0) tia.enabled = object_bit(kPlayfield);
    const int first = static_cast<int>(random() % kLinePixels);
    const int last = first + 1 + static_cast<int>(random() % static_cast<unsigned>(kLinePixels - first));

    constexpr int kMargin = 64;
    alignas(64) std::array<std::uint8_t, kMargin + kLinePixels + kMargin> before;
    for (std::uint8_t& byte : before) byte = static_cast<std::uint8_t>(random());
    auto expected = before;
    for (int pixel = first; pixel < last; ++pixel) {
      expected[kMargin + static_cast<std::size_t>(pixel)] = tia.color[color_of(line, tia, pixel)];
    }
    for (const Simd form : supported_simd()) {
      INFO("round " << round << ", form " << static_cast<int>(form) << ", pixels " << first << " to "
                    << last);
      alignas(64) auto picture = before;
      pixel_drawer(form)(line, tia, picture.data() + kMargin, first, last);
      REQUIRE(picture == expected);
    }
  }
}

}  // namespace
}  // namespace racebeam::test

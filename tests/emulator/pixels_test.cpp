// Every form of the code that draws pixels, as far as this processor can run it, against one pixel after the other.
#include <catch2/catch.hpp>
#include <random>

#include "emulator/pixels.hpp"

namespace racebeam::test {
namespace {

bool covers(const PixelMask& mask, int pixel) {
  return (mask.word[static_cast<std::size_t>(pixel) / 64] >> (pixel % 64) & 1) != 0;
}

// Dense, sparse, or nothing.
PixelMask random_mask(std::mt19937_64& random) {
  PixelMask mask;
  const auto density = random() % 4;
  for (std::uint64_t& word : mask.word) word = density == 0 ? 0 : density == 1 ? random() & random() & random() & random() : random();
  mask.word[2] &= 0xFFFFFFFF;
  return mask;
}

TEST_CASE("All forms of drawing give the same pixels, and touch no others") {
  std::mt19937_64 random(1);
  const int best = static_cast<int>(best_simd());
  if (best < static_cast<int>(Simd::kAvx512)) WARN("SKIPPED: forms that this processor can't run");
  for (int round = 0; round < 20000; ++round) {
    Line line;
    TiaRegisters tia;
    for (std::uint8_t& color : tia.color) color = static_cast<std::uint8_t>(random());
    line.layers = random() % 4;
    for (Layer& layer : line.layer) layer = {random_mask(random), static_cast<unsigned>(random() % 4)};
    const int first = static_cast<int>(random() % kLinePixels);
    const int last = first + 1 + static_cast<int>(random() % static_cast<unsigned>(kLinePixels - first));

    constexpr int kMargin = 64;
    alignas(64) std::array<std::uint8_t, kMargin + kLinePixels + kMargin> before;
    for (std::uint8_t& byte : before) byte = static_cast<std::uint8_t>(random());
    auto expected = before;
    for (int pixel = first; pixel < last; ++pixel) {
      std::uint8_t color = tia.color[kColubk];
      for (const Layer& layer : line.shown_layers())
        if (covers(layer.mask, pixel)) color = tia.color[layer.color];
      expected[static_cast<std::size_t>(kMargin + pixel)] = color;
    }
    for (int form = 0; form <= best; ++form) {
      INFO("round " << round << ", form " << form << ", pixels " << first << " to " << last);
      alignas(64) auto drawn = before;
      pixel_drawer(static_cast<Simd>(form))(line, tia, drawn.data() + kMargin, first, last);
      REQUIRE(drawn == expected);
    }
  }
}

}  // namespace
}  // namespace racebeam::test

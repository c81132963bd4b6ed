// Compares each form of the code that looks up brightness, if this processor supports it, with the table.
#include "environment/observe/brightness.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "tests/support/skip.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kRow = 160, kMargin = 64;
using Pixels = std::array<std::uint8_t, kRow + kMargin>;  // a row begins anywhere in the first bytes

// Long runs of one colour, short ones, or none; colours that are all even, or seldom odd, or any.
Pixels random_pixels(std::mt19937& random) {
  const unsigned run = 1U << random() % 8, kind = static_cast<unsigned>(random() % 3);
  Pixels pixels{};
  std::uint8_t colour = 0;
  for (std::uint8_t& pixel : pixels) {
    if (random() % run == 0) colour = static_cast<std::uint8_t>(random());
    const bool may_be_odd = kind == 2 || (kind == 1 && random() % 500 == 0);
    pixel = may_be_odd ? colour : static_cast<std::uint8_t>(colour & 0xFE);
  }
  return pixels;
}

// Fills a row between margins, which must stay as they are.
template <typename Make>
std::array<std::uint8_t, kRow + 2 * kMargin> result_of(Make make) {
  std::array<std::uint8_t, kRow + 2 * kMargin> bytes;
  bytes.fill(77);
  make(bytes.data() + kMargin);
  return bytes;
}

TEST_CASE("All forms of brightness give the bytes of the table, and touch no others") {
  std::mt19937 random(1);
  if (kHasAvx && !has_vbmi()) test::leave_out("a form that this processor can't run");
  BrightnessTable table;
  for (int round = 0; round < 20000; ++round) {
    if (round % 100 == 0) std::ranges::generate(table, [&] { return static_cast<std::uint8_t>(random()); });
    const Pixels first = random_pixels(random), second = random() % 8 == 0 ? first : random_pixels(random);
    const std::uint8_t* const one = first.data() + random() % kMargin;
    const std::uint8_t* const other = second.data() + random() % kMargin;
    const auto expected = result_of([&](std::uint8_t* to) {
      for (std::size_t x = 0; x < kRow; ++x) to[x] = table[one[x]];
    });
    const auto brighter = result_of([&](std::uint8_t* to) {
      for (std::size_t x = 0; x < kRow; ++x) to[x] = std::max(table[one[x]], table[other[x]]);
    });
    for (const Simd form : supported_simd()) {
      INFO("round " << round << ", form " << static_cast<int>(form));
      const Brightness brightness(table, form);
      REQUIRE(result_of([&](std::uint8_t* to) { brightness.make_row(one, to); }) == expected);
      REQUIRE(result_of([&](std::uint8_t* to) { brightness.make_brighter_row(one, other, to); }) == brighter);
    }
  }
}

TEST_CASE("All forms of brightness know all 256 palette indices") {
  for (const Format format : {Format::kNtsc, Format::kPal, Format::kSecam}) {
    const BrightnessTable& table = grey_table(format);
    for (const Simd form : supported_simd()) {
      const Brightness brightness(table, form);
      for (unsigned index = 0; index < table.size(); ++index) {
        std::array<std::uint8_t, kRow> pixels, bytes;
        pixels.fill(static_cast<std::uint8_t>(index));
        brightness.make_row(pixels.data(), bytes.data());
        REQUIRE(std::ranges::count(bytes, table[index]) == kRow);
        CHECK(brightness.of(pixels[0]) == table[index]);
      }
    }
  }
}

}  // namespace
}  // namespace racebeam

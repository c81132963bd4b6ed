#include <catch2/catch.hpp>
#include <ctime>

#include "emulator/tia/palette.hpp"

namespace racebeam {
namespace {

struct Shade {
  std::uint8_t entry;
  Rgb rgb;
  std::uint8_t grey;
};

void check(Format format, const Shade& shade) {
  INFO("entry " << int{shade.entry});
  CHECK(palette(format)[shade.entry] == shade.rgb);
  CHECK(grey_table(format)[shade.entry] == shade.grey);
  CHECK(palette(format)[shade.entry + 1u] == Rgb{shade.grey, shade.grey, shade.grey});
}

// docs/spec/palette.md, "How to check", 3: a, b, what both give
constexpr std::uint8_t kNtscBlends[][3] = {{0x0E, 0x00, 0x08},
                                           {0x44, 0x84, 0x54},
                                           {0x1A, 0x36, 0x18},
                                           {0xC8, 0x00, 0xC6},
                                           // docs/spec/environment.md, 17
                                           {0x36, 0xC8, 0xE8},
                                           {0x44, 0x86, 0x56},
                                           {0x1A, 0x00, 0x16},
                                           {0x90, 0x90, 0x90}};

TEST_CASE("NTSC entries have their colour and their grey") {
  const Shade shades[] = {{0x0E, {0xEC, 0xEC, 0xEC}, 0xEC}, {0x1A, {0xD2, 0xD2, 0x40}, 0xC1},
                          {0x44, {0xB8, 0x32, 0x32}, 0x5A}, {0x84, {0x2D, 0x32, 0xB8}, 0x40},
                          {0xC8, {0x5C, 0xBA, 0x5C}, 0x93}, {0xFE, {0xFC, 0xE0, 0x70}, 0xDC}};
  for (const Shade& shade : shades) check(Format::kNtsc, shade);
}

TEST_CASE("PAL entries have their colour and their grey, in PAL60 too") {
  const Shade shades[] = {
      {0x0E, {0xEC, 0xEC, 0xEC}, 0xEC}, {0x44, {0xA0, 0x6B, 0x32}, 0x74}, {0xD8, {0x5C, 0x5C, 0xD2}, 0x69}};
  for (const Shade& shade : shades) check(Format::kPal, shade);
  CHECK(palette(Format::kPal60) == palette(Format::kPal));
}

TEST_CASE("SECAM has the same eight colours for every hue") {
  const Palette& colours = palette(Format::kSecam);
  CHECK(colours[0x04] == Rgb{0xF0, 0x3C, 0x79});
  CHECK(colours[0x0E] == Rgb{0xFF, 0xFF, 0xFF});
  for (std::size_t v = 16; v < 256; ++v) CHECK(colours[v] == colours[v % 16]);
}

TEST_CASE("A byte of colour loss is grey in RGB, and the next colour's blue in the grey picture") {
  CHECK(palette(Format::kPal)[0x81] == Rgb{0x2C, 0x2C, 0x2C});
  CHECK(grey_table(Format::kPal)[0x81] == 0x74);
  CHECK(grey_table(Format::kPal)[0xFF] == 0);  // past the table
}

TEST_CASE("Colours blend as in the reference, whichever comes first") {
  const Blend& average = blend(Format::kNtsc);
  for (const auto& [a, b, expected] : kNtscBlends) {
    CHECK(average(a, b) == expected);
    CHECK(average(b, a) == expected);
  }
}

TEST_CASE("An NTSC colour blended with itself is itself") {
  for (unsigned v = 0; v < 256; v += 2) {
    const auto colour = static_cast<std::uint8_t>(v);
    CHECK(blend(Format::kNtsc)(colour, colour) == colour);
  }
}

TEST_CASE("PAL's repeated greys blend to those of hue 0, all else with itself is itself") {
  int same = 0;
  for (unsigned v = 0; v < 256; v += 2) {
    const auto colour = static_cast<std::uint8_t>(v);
    const std::uint8_t blended = blend(Format::kPal)(colour, colour);
    const unsigned hue = v >> 4;
    CHECK(blended == (hue == 1 || hue >= 14 ? v & 15 : v));
    same += blended == colour;
  }
  CHECK(same == 104);
}

TEST_CASE("Blending with a byte of colour loss gives 0") {
  CHECK(blend(Format::kPal)(0x45, 0x44) == 0);
  CHECK(blend(Format::kPal)(0x44, 0x45) == 0);
  CHECK(blend(Format::kNtsc)(0x45, 0x45) == 0);
}

TEST_CASE("Whole pictures blend pixel by pixel, equal or not") {
  std::array<std::uint8_t, 1003> a{}, b{}, out{};
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = static_cast<std::uint8_t>(i / 16 * 2);
    b[i] = static_cast<std::uint8_t>(i % 48 < 24 ? a[i] : i * 7);
  }
  a[8] = b[8] = 0x33;  // odd in a group of eight that is equal
  for (const Format format : {Format::kNtsc, Format::kPal, Format::kSecam}) {
    blend(format)(a, b, out);
    for (std::size_t i = 0; i < a.size(); ++i) REQUIRE(out[i] == blend(format)(a[i], b[i]));
  }
}

TEST_CASE("A blending table is made in a few milliseconds") {
  const std::clock_t start = std::clock();  // processor time: other programs do not count
  const Blend blend(palette(Format::kNtsc));
  const double took = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  CHECK(blend(0x0E, 0x00) == 0x08);
  CHECK(took < 0.25);  // 3 ms in a release build; generous for sanitizers
}

}  // namespace
}  // namespace racebeam

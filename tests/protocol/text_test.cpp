#include "protocol/encoding/text.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

using namespace racebeam;

namespace {

using Pixels = std::vector<std::uint8_t>;

std::string run_length(const Pixels& pixels, Simd form = simd()) {
  std::string text;
  append_run_length(text, pixels, form);
  return text;
}

// A pixel-by-pixel model, from the specification.
std::string run_length_slowly(const Pixels& pixels) {
  std::string text;
  for (std::size_t at = 0; at < pixels.size();) {
    std::uint8_t length = 0;
    const std::uint8_t color = pixels[at];
    while (at < pixels.size() && pixels[at] == color && length < 255) ++at, ++length;
    append_hex(text, std::array{color, length});
  }
  return text;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace

TEST_CASE("Numbers are read as C's atoi reads them") {
  CHECK(parse_integer("17") == 17);
  CHECK(parse_integer(" \t\r 3 ") == 3);
  CHECK(parse_integer("-5") == -5);
  CHECK(parse_integer("+18") == 18);
  CHECK(parse_integer("3rd") == 3);
  CHECK(parse_integer("- 3") == 0);
  CHECK(parse_integer("--3") == 0);
  CHECK(parse_integer("fire") == 0);
  CHECK(parse_integer("") == 0);
  CHECK(parse_integer("007") == 7);
}

TEST_CASE("A number that does not fit an int becomes the nearest that does") {
  CHECK(parse_integer("2147483647") == std::numeric_limits<int>::max());
  CHECK(parse_integer("2147483648") == std::numeric_limits<int>::max());
  CHECK(parse_integer(std::string(1000, '9')) == std::numeric_limits<int>::max());
  CHECK(parse_integer("-2147483648") == std::numeric_limits<int>::min());
  CHECK(parse_integer("-" + std::string(1000, '9')) == std::numeric_limits<int>::min());
}

TEST_CASE("A line is cut at commas, and its empty parts are skipped") {
  std::array<int, 2> numbers{};
  CHECK(parse_integers("3,18", numbers) == 2);
  CHECK(numbers == std::array{3, 18});
  CHECK(parse_integers(" 4 , 19 ,7\r", numbers) == 2);
  CHECK(numbers == std::array{4, 19});
  CHECK(parse_integers(",,5,,,20,", numbers) == 2);
  CHECK(numbers == std::array{5, 20});
}

TEST_CASE("A line with too few parts says how many there were") {
  std::array<int, 4> numbers{};
  CHECK(parse_integers("", numbers) == 0);
  CHECK(parse_integers(",,,", numbers) == 0);
  CHECK(parse_integers("1", numbers) == 1);
  CHECK(parse_integers("1,1,0", numbers) == 3);
  CHECK(parse_integers(" ,1", numbers) == 2);  // a blank is a part: 0
}

TEST_CASE("Hexadecimal is upper case, two digits a byte, and is added to what is there") {
  std::string text = "x";
  append_hex(text, std::array<std::uint8_t, 5>{0x00, 0x0F, 0xA0, 0x9C, 0xFF});
  CHECK(text == "x000FA09CFF");
}

TEST_CASE("A blank screen is 131 full runs and one of 195 pixels") {
  CHECK(run_length(Pixels(160 * 210, 0)) == repeated("00FF", 131) + "00C3");
}

TEST_CASE("A run of 255 is one group, one of 256 begins another") {
  CHECK(run_length(Pixels(254, 0x1E)) == "1EFE");
  CHECK(run_length(Pixels(255, 0x1E)) == "1EFF");
  CHECK(run_length(Pixels(256, 0x1E)) == "1EFF1E01");
  CHECK(run_length(Pixels(510, 0x1E)) == "1EFF1EFF");
  CHECK(run_length(Pixels(511, 0x1E)) == "1EFF1EFF1E01");
}

TEST_CASE("Runs go on across the ends of rows") {
  Pixels pixels(320, 0x00);
  for (int x = 150; x < 170; ++x) pixels[x] = 0x0E;
  CHECK(run_length(pixels) == "00960E140096");
}

TEST_CASE("A separate colour for every pixel gives a group each") {
  CHECK(run_length({1, 2, 3, 2, 2, 1}) == "01010201030102020101");
  CHECK(run_length({}).empty());
}

TEST_CASE("Runs that end anywhere in a word of eight pixels are found") {
  for (std::size_t length = 1; length < 40; ++length) {
    for (std::size_t tail = 0; tail < 20; ++tail) {
      Pixels pixels(length, 0x80);
      pixels.insert(pixels.end(), tail, 0x81);
      CHECK(run_length(pixels) == run_length_slowly(pixels));
    }
  }
}

TEST_CASE("Random pictures give the text that the slow way gives") {
  std::mt19937 random(1);
  for (int picture = 0; picture < 200; ++picture) {
    Pixels pixels;
    while (pixels.size() < 5000) pixels.insert(pixels.end(), 1 + random() % (picture + 1) * 3, random() % 4);
    CHECK(run_length(pixels) == run_length_slowly(pixels));
    CHECK(run_length(pixels, Simd::kPlain) == run_length_slowly(pixels));
  }
}

// Rows as in screens: repeated rows, rows of one colour, alternating rows, and an incomplete row.
Pixels random_rows(std::mt19937& random) {
  std::vector<Pixels> kinds;
  for (int kind = 0; kind < 6; ++kind) {
    Pixels row;
    while (row.size() < 160)
      row.insert(row.end(), 1 + random() % (1U << random() % 9), std::uint8_t(random() % 3));
    row.resize(160);
    kinds.push_back(row);
  }
  Pixels pixels;
  for (auto rows = random() % 260; rows > 0; --rows) {
    const Pixels& row = kinds[random() % 8 % kinds.size()];
    for (auto times = 1 + random() % (1U << random() % 5); times > 0; --times)
      pixels.insert(pixels.end(), row.begin(), row.end());
  }
  pixels.insert(pixels.end(), random() % 160, static_cast<std::uint8_t>(random() % 3));
  return pixels;
}

TEST_CASE("Rows that repeat give the text that the slow way gives") {
  std::mt19937 random(5);
  for (int picture = 0; picture < 500; ++picture) {
    const Pixels pixels = random_rows(random);
    const std::string expected = run_length_slowly(pixels);
    CHECK(run_length(pixels) == expected);
    CHECK(run_length(pixels, Simd::kPlain) == expected);
  }
}

TEST_CASE("Text is added to what is there, also when it is long") {
  std::string text = "x";
  Pixels pixels(33600);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i);
  append_run_length(text, pixels);
  CHECK(text.substr(0, 1) == "x");
  CHECK(text.substr(1) == run_length_slowly(pixels));
}

TEST_CASE("Hexadecimal is the same in every form, whatever the length") {
  std::mt19937 random(9);
  for (std::size_t size = 0; size < 200; ++size) {
    Pixels bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    std::string best, plain, printed;
    append_hex(best, bytes);
    append_hex(plain, bytes, Simd::kPlain);
    for (const std::uint8_t byte : bytes) {
      char digits[3];
      std::snprintf(digits, sizeof digits, "%02X", byte);
      printed += digits;
    }
    CHECK(best == printed);
    CHECK(plain == printed);
  }
}

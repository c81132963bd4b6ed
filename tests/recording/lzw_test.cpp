// Data that is compressed for a GIF, read by a decoder that is written after the specification, GIF89a,
// appendix F.
#include "recording/lzw.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/recording/lzw_decoder.hpp"

using racebeam::Lzw;
using namespace racebeam::test;

namespace {

Decoded there_and_back(Lzw& lzw, const Bytes& pixels) {
  Bytes data = {1, 2, 3};  // the file so far, which the encoder must not change
  lzw.append(data, pixels);
  REQUIRE(Bytes(data.begin(), data.begin() + 3) == Bytes{1, 2, 3});
  Decoded result = decoded(Bytes(data.begin() + 3, data.end()));
  REQUIRE((result.pixels == pixels));
  return result;
}

Bytes random_pixels(std::size_t count, unsigned colours) {
  std::mt19937 random(static_cast<unsigned>(count) + colours);
  Bytes pixels(count);
  for (std::uint8_t& pixel : pixels) pixel = static_cast<std::uint8_t>(random() % colours);
  return pixels;
}

TEST_CASE("Compressed pixels are those that went in, whatever they are") {
  Lzw lzw;
  CHECK(there_and_back(lzw, {}).codes == 2);
  CHECK(there_and_back(lzw, {7}).codes == 3);
  CHECK(there_and_back(lzw, {7, 7}).codes == 4);
  CHECK(there_and_back(lzw, {7, 7, 7}).codes == 4);  // the second code is the one that it makes
  for (const unsigned colours : {1U, 2U, 5U, 128U, 256U})
    for (const std::size_t count : {100U, 254U, 255U, 256U, 257U, 5000U, 67200U})
      there_and_back(lzw, random_pixels(count, colours));
}

TEST_CASE("Blocks have 255 bytes but for the last, which is not empty") {
  Lzw lzw;
  for (std::size_t count = 215; count < 240; ++count) there_and_back(lzw, random_pixels(count, 256));
}

TEST_CASE("The table of strings is cleared when it is full, and not before") {
  Lzw lzw;
  // No pair of neighbours repeats, so that each pixel after the first makes a code: 3838 fill the table.
  Bytes pixels;
  for (unsigned step = 1; pixels.size() < 8000; step += 2)
    for (unsigned place = 0; place < 256; ++place) pixels.push_back(static_cast<std::uint8_t>(place * step));
  const auto clears = [&](std::ptrdiff_t count) {
    return there_and_back(lzw, Bytes(pixels.begin(), pixels.begin() + count)).clears;
  };
  CHECK(clears(3839) == 1);
  CHECK(clears(3840) == 2);
  CHECK(clears(7678) == 2);
  CHECK(clears(7679) == 3);
}

TEST_CASE("What was compressed before makes no difference") {
  Lzw used, fresh;
  const Bytes pixels = random_pixels(3001, 20);
  there_and_back(used, random_pixels(5001, 256));
  Bytes one, other;
  used.append(one, pixels);
  fresh.append(other, pixels);
  CHECK((one == other));
}

}  // namespace

// Data that is compressed for a GIF, read by a decoder that is written after the specification, GIF89a,
// appendix F.
#include "recording/lzw.hpp"

#include <catch2/catch.hpp>
#include <random>

using racebeam::Lzw;

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kClear = 256, kEnd = 257, kMostCodes = 4096;

// The bytes of the blocks, of which all but the last must be full. The last is followed by an empty one.
Bytes joined(const Bytes& blocks) {
  Bytes bytes;
  std::size_t at = 0;
  while (blocks.at(at) != 0) {
    const std::size_t size = blocks[at];
    for (std::size_t i = 1; i <= size; ++i) bytes.push_back(blocks.at(at + i));
    at += 1 + size;
    REQUIRE((size == 255 || blocks.at(at) == 0));
  }
  REQUIRE(at + 1 == blocks.size());
  return bytes;
}

struct Decoded {
  Bytes pixels;
  int clears = 0;
  std::size_t codes = 0;
};

Decoded decoded(const Bytes& data) {
  REQUIRE(data.at(0) == 8);  // the width of a pixel
  const Bytes packed = joined(Bytes(data.begin() + 1, data.end()));
  Decoded result;
  std::vector<Bytes> table;
  unsigned width = 9;
  Bytes before;
  std::size_t bit = 0;
  for (;;) {
    unsigned code = 0;
    for (unsigned i = 0; i < width; ++i, ++bit) code |= (packed.at(bit / 8) >> bit % 8 & 1U) << i;
    ++result.codes;
    if (result.codes == 1) REQUIRE(code == kClear);
    if (code == kEnd) break;
    if (code == kClear) {
      table.assign(kEnd + 1, {});
      for (unsigned pixel = 0; pixel < kClear; ++pixel) table[pixel] = {static_cast<std::uint8_t>(pixel)};
      width = 9;
      before.clear();
      ++result.clears;
      continue;
    }
    REQUIRE(code <= table.size());
    Bytes now = code < table.size() ? table[code] : before;
    if (code == table.size()) now.push_back(before.at(0));
    if (!before.empty() && table.size() < kMostCodes) {
      before.push_back(now.at(0));
      table.push_back(before);
      if (table.size() == 1U << width && width < 12) ++width;
    }
    result.pixels.insert(result.pixels.end(), now.begin(), now.end());
    before = std::move(now);
  }
  REQUIRE(packed.size() == (bit + 7) / 8);
  for (; bit < 8 * packed.size(); ++bit) REQUIRE((packed[bit / 8] >> bit % 8 & 1U) == 0);
  return result;
}

Decoded there_and_back(Lzw& lzw, const Bytes& pixels) {
  Bytes data = {1, 2, 3};  // of the file, and left alone
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

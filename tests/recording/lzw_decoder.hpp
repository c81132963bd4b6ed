// A decoder of the data of a GIF, written after the specification: GIF89a, appendix F.
#pragma once

#include <catch2/catch.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace racebeam::test {

using Bytes = std::vector<std::uint8_t>;

constexpr unsigned kClear = 256, kEnd = 257, kMaxCodes = 4096;

// The bytes of the blocks, of which all but the last must be full. The last is followed by an empty one.
inline Bytes joined(const Bytes& blocks) {
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

inline Decoded decoded(const Bytes& data) {
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
    if (!before.empty() && table.size() < kMaxCodes) {
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

}  // namespace racebeam::test

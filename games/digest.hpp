// The common part of MD5 (RFC 1321) and SHA-256 (FIPS 180-4): blocks of 64 bytes, and padding with the
// length.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace racebeam {

// The four bytes at `at` as a number.
template <std::endian kOrder>
std::uint32_t word_at(const std::uint8_t* at) {
  std::uint32_t word = 0;
  for (unsigned i = 0; i < 4; ++i)
    word |= std::uint32_t{at[i]} << 8 * (kOrder == std::endian::little ? i : 3 - i);
  return word;
}

// The sum of all bytes that were added. `Function` has kOrder, the order of bytes in words; kFirst, the state
// before the first block; and add_block(state, block).
template <typename Function>
class Digest {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const std::size_t used = length_ % kBlock, count = std::min(kBlock - used, bytes.size());
      std::ranges::copy(bytes.first(count), block_.begin() + used);
      bytes = bytes.subspan(count);
      length_ += count;
      if (used + count == kBlock) Function::add_block(state_, block_.data());
    }
  }

  // In lower case. The padding is a set bit, then zeros until 8 bytes of a block are left for the length in
  // bits.
  std::string hex() const {
    Digest whole = *this;
    std::array<std::uint8_t, kBlock + kLength> end{0x80};
    const std::size_t zeros = (2 * kBlock - 1 - kLength - length_ % kBlock) % kBlock;
    for (unsigned i = 0; i < kLength; ++i) end[1 + zeros + i] = byte_of(length_ * 8, i);
    whole.add(std::span(end).first(1 + zeros + kLength));
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint32_t word : whole.state_) {
      for (unsigned i = 0; i < sizeof word; ++i) {
        text += kDigits[byte_of(word, i) >> 4];
        text += kDigits[byte_of(word, i) & 15];
      }
    }
    return text;
  }

 private:
  static constexpr std::size_t kBlock = 64, kLength = 8;

  // Byte `i` of a number in memory.
  template <typename Number>
  static std::uint8_t byte_of(Number number, unsigned i) {
    const unsigned place = Function::kOrder == std::endian::little ? i : sizeof number - 1 - i;
    return static_cast<std::uint8_t>(number >> 8 * place);
  }

  std::array<std::uint32_t, Function::kFirst.size()> state_ = Function::kFirst;
  std::array<std::uint8_t, kBlock> block_{};  // the last bytes, until they are a whole block
  std::uint64_t length_ = 0;                  // bytes so far
};

}  // namespace racebeam

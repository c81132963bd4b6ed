#include "games/md5.hpp"

#include <bit>

#include "games/digest.hpp"

namespace racebeam {
namespace {

// RFC 1321, 3.4. T[i] is the whole part of 2^32 * abs(sin(i + 1)).
constexpr std::array<std::uint32_t, 64> kT = {
    0xD76AA478, 0xE8C7B756, 0x242070DB, 0xC1BDCEEE, 0xF57C0FAF, 0x4787C62A, 0xA8304613, 0xFD469501,
    0x698098D8, 0x8B44F7AF, 0xFFFF5BB1, 0x895CD7BE, 0x6B901122, 0xFD987193, 0xA679438E, 0x49B40821,
    0xF61E2562, 0xC040B340, 0x265E5A51, 0xE9B6C7AA, 0xD62F105D, 0x02441453, 0xD8A1E681, 0xE7D3FBC8,
    0x21E1CDE6, 0xC33707D6, 0xF4D50D87, 0x455A14ED, 0xA9E3E905, 0xFCEFA3F8, 0x676F02D9, 0x8D2A4C8A,
    0xFFFA3942, 0x8771F681, 0x6D9D6122, 0xFDE5380C, 0xA4BEEA44, 0x4BDECFA9, 0xF6BB4B60, 0xBEBFBC70,
    0x289B7EC6, 0xEAA127FA, 0xD4EF3085, 0x04881D05, 0xD9D4D039, 0xE6DB99E5, 0x1FA27CF8, 0xC4AC5665,
    0xF4292244, 0x432AFF97, 0xAB9423A7, 0xFC93A039, 0x655B59C3, 0x8F0CCC92, 0xFFEFF47D, 0x85845DD1,
    0x6FA87E4F, 0xFE2CE6E0, 0xA3014314, 0x4E0811A1, 0xF7537E82, 0xBD3AF235, 0x2AD7D2BB, 0xEB86D391};

constexpr std::array<std::array<int, 4>, 4> kTurns = {
    {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}}};

// The word of the block that step `i` adds.
constexpr unsigned word_of(unsigned i) {
  constexpr std::array<unsigned, 4> kFirst = {0, 1, 5, 0}, kStride = {1, 5, 3, 7};
  return (kFirst[i / 16] + kStride[i / 16] * i) % 16;
}

constexpr std::uint32_t mix(unsigned round, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  switch (round) {
    case 0: return (b & c) | (~b & d);
    case 1: return (b & d) | (c & ~d);
    case 2: return b ^ c ^ d;
    default: return c ^ (b | ~d);
  }
}

struct Md5 {
  static constexpr std::endian kOrder = std::endian::little;
  static constexpr std::array<std::uint32_t, 4> kFirst = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476};

  static void add_block(std::array<std::uint32_t, 4>& state, const std::uint8_t* block) {
    auto [a, b, c, d] = state;
    for (unsigned i = 0; i < 64; ++i) {
      const std::uint32_t sum = a + mix(i / 16, b, c, d) + word_at<kOrder>(block + 4 * word_of(i)) + kT[i];
      a = d;
      d = c;
      c = b;
      b += std::rotl(sum, kTurns[i / 16][i % 4]);
    }
    state = {state[0] + a, state[1] + b, state[2] + c, state[3] + d};
  }
};

}  // namespace

std::string md5_of(std::span<const std::uint8_t> bytes) {
  Digest<Md5> sum;
  sum.add(bytes);
  return sum.hex();
}

}  // namespace racebeam

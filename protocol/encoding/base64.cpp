#include "protocol/encoding/base64.hpp"

#include <array>
#include <bit>
#include <cstring>

namespace racebeam {
namespace {

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNone = 64;

constexpr std::array<std::uint8_t, 256> kValues = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNone);
  for (std::size_t i = 0; i < kLetters.size(); ++i) {
    values[static_cast<std::uint8_t>(kLetters[i])] = static_cast<std::uint8_t>(i);
  }
  return values;
}();

static_assert(std::endian::native == std::endian::little, "the first letter is the low half of a pair");

constexpr std::array<std::uint16_t, 4096> kPairs = [] {  // the two letters of 12 bits
  std::array<std::uint16_t, 4096> pairs{};
  for (std::size_t bits = 0; bits < pairs.size(); ++bits)
    pairs[bits] = static_cast<std::uint16_t>(kLetters[bits / 64] | kLetters[bits % 64] << 8);
  return pairs;
}();

char letter(std::uint32_t bits, int place) { return kLetters[bits >> (18 - 6 * place) & 63]; }

// Eight letters, of the first six of eight bytes.
std::uint64_t eight_letters(const std::uint8_t* bytes) {
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  bits = __builtin_bswap64(bits);
  std::uint64_t letters = 0;
  for (int pair = 0; pair < 4; ++pair)
    letters |= std::uint64_t{kPairs[bits >> (52 - 12 * pair) & 4095]} << 16 * pair;
  return letters;
}

}  // namespace

void append_base64(std::string& out, std::span<const std::uint8_t> bytes) {
  const std::size_t start = out.size();
  out.resize(start + (bytes.size() + 2) / 3 * 4);
  char* to = out.data() + start;
  std::size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 6, to += 8) {
    const std::uint64_t letters = eight_letters(&bytes[at]);
    std::memcpy(to, &letters, sizeof letters);
  }
  for (; at + 3 <= bytes.size(); at += 3) {
    const std::uint32_t bits = bytes[at] << 16 | bytes[at + 1] << 8 | bytes[at + 2];
    for (int place = 0; place < 4; ++place) *to++ = letter(bits, place);
  }
  const std::size_t rest = bytes.size() - at;
  if (rest == 0) return;
  const std::uint32_t bits = bytes[at] << 16 | (rest == 2 ? bytes[at + 1] << 8 : 0);
  *to++ = letter(bits, 0);
  *to++ = letter(bits, 1);
  *to++ = rest == 2 ? letter(bits, 2) : '=';
  *to++ = '=';
}

std::optional<std::vector<std::uint8_t>> bytes_of_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) text.remove_suffix(1), ++padding;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int pending = 0;  // bits that were read but not yet written
  for (const char c : text) {
    const std::uint8_t value = kValues[static_cast<std::uint8_t>(c)];
    if (value == kNone) return std::nullopt;
    bits = bits << 6 | value;
    pending += 6;
    if (pending < 8) continue;
    pending -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> pending));
  }
  const bool clean = (bits & ((1U << pending) - 1)) == 0;
  return clean ? std::optional(std::move(bytes)) : std::nullopt;
}

}  // namespace racebeam

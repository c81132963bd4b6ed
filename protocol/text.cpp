#include "protocol/text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace racebeam {
namespace {

using Pair = std::array<char, 2>;

constexpr std::array<Pair, 256> kHexPairs = [] {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::array<Pair, 256> pairs{};
  for (std::size_t byte = 0; byte < pairs.size(); ++byte)
    pairs[byte] = {kDigits[byte / 16], kDigits[byte % 16]};
  return pairs;
}();

constexpr std::ptrdiff_t kLongestRun = 255;
constexpr std::ptrdiff_t kWord = sizeof(std::uint64_t);

// The first pixel in [from, end) that is not `color`; eight are compared at a time. The first pixel is the
// lowest byte of the word.
static_assert(std::endian::native == std::endian::little);
const std::uint8_t* find_other(const std::uint8_t* from, const std::uint8_t* end, std::uint8_t color) {
  const std::uint64_t same = color * 0x0101010101010101U;
  for (; end - from >= kWord; from += kWord) {
    std::uint64_t word;
    std::memcpy(&word, from, kWord);
    if (word != same) return from + std::countr_zero(word ^ same) / 8;
  }
  while (from != end && *from == color) ++from;
  return from;
}

// Groups on their way to the text; many at a time, since growing a string costs more than a run does.
class Runs {
 public:
  explicit Runs(std::string& out) : out_(out) {}
  ~Runs() { flush(); }
  Runs(const Runs&) = delete;
  Runs& operator=(const Runs&) = delete;

  void add(std::uint8_t color, std::size_t length) {
    if (used_ == text_.size()) flush();
    std::memcpy(&text_[used_], kHexPairs[color].data(), 2);
    std::memcpy(&text_[used_ + 2], kHexPairs[length].data(), 2);
    used_ += 4;
  }

 private:
  void flush() {
    out_.append(text_.data(), used_);
    used_ = 0;
  }

  std::string& out_;
  std::array<char, 1024> text_;
  std::size_t used_ = 0;
};

bool is_blank(char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }
bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

}  // namespace

int parse_integer(std::string_view text) {
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();
  std::size_t at = 0;
  while (at < text.size() && is_blank(text[at])) ++at;
  const bool negative = at < text.size() && text[at] == '-';
  if (at < text.size() && (negative || text[at] == '+')) ++at;
  std::int64_t value = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) value = std::min(value * 10 + (text[at] - '0'), kMost);
  return static_cast<int>(negative ? -value : value);
}

std::size_t parse_integers(std::string_view line, std::span<int> values) {
  std::size_t found = 0;
  while (found < values.size() && !line.empty()) {
    const std::string_view part = line.substr(0, line.find(','));
    line.remove_prefix(std::min(part.size() + 1, line.size()));
    if (!part.empty()) values[found++] = parse_integer(part);
  }
  return found;
}

void append_hex(std::string& out, std::span<const std::uint8_t> bytes) {
  const std::size_t start = out.size();
  out.resize(start + 2 * bytes.size());
  char* to = out.data() + start;
  for (const std::uint8_t byte : bytes) {
    std::memcpy(to, kHexPairs[byte].data(), 2);
    to += 2;
  }
}

void append_run_length(std::string& out, std::span<const std::uint8_t> pixels) {
  const std::uint8_t* at = pixels.data();
  const std::uint8_t* const end = at + pixels.size();
  Runs runs(out);
  while (at != end) {
    const std::uint8_t color = *at;
    const std::uint8_t* const next = find_other(at + 1, end, color);
    for (; next - at > kLongestRun; at += kLongestRun) runs.add(color, kLongestRun);
    runs.add(color, static_cast<std::size_t>(next - at));
    at = next;
  }
}

}  // namespace racebeam

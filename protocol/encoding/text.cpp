#include "protocol/encoding/text.hpp"

#include <algorithm>
#include <limits>

namespace racebeam {
namespace {

bool is_blank(char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }
bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

}  // namespace

int parse_integer(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size() && is_blank(text[at])) ++at;
  const bool negative = at < text.size() && text[at] == '-';
  if (at < text.size() && (negative || text[at] == '+')) ++at;
  const std::int64_t most = std::int64_t{std::numeric_limits<int>::max()} + negative;
  std::int64_t value = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) value = std::min(value * 10 + (text[at] - '0'), most);
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

}  // namespace racebeam

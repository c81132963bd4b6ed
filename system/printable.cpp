#include "system/printable.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace racebeam {
namespace {

struct Form {
  unsigned char mask, lead;  // of the first byte
  std::uint32_t least;       // the least code point of this length
};
constexpr std::array<Form, 4> kForms = {
    {{0x80, 0x00, 0}, {0xE0, 0xC0, 0x80}, {0xF0, 0xE0, 0x800}, {0xF8, 0xF0, 0x10000}}};

bool is_control(std::uint32_t character) {
  return character < 0x20 || (character >= 0x7F && character < 0xA0);
}

bool is_character(std::uint32_t number) {
  return number <= 0x10FFFF && !(number >= 0xD800 && number <= 0xDFFF) && !is_control(number);
}

// Returns the number of bytes of the first character of the text, which is not empty; 0 if that character
// must not be printed.
std::size_t shown_at_front(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  for (std::size_t more = 0; more < kForms.size(); ++more) {
    const Form& form = kForms[more];
    if ((first & form.mask) != form.lead || more >= text.size()) continue;
    std::uint32_t character = first & ~form.mask & 0xFFU;
    for (const char c : text.substr(1, more)) {
      if ((c & 0xC0) != 0x80) return 0;
      character = character << 6 | (c & 0x3FU);
    }
    return character >= form.least && is_character(character) ? more + 1 : 0;
  }
  return 0;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  while (!text.empty()) {
    const std::size_t front = shown_at_front(text);
    if (front > 0) {
      out += text.substr(0, front);
    } else {
      const auto byte = static_cast<unsigned char>(text.front());
      ((out += "\\x") += kDigits[byte >> 4]) += kDigits[byte & 15];
    }
    text.remove_prefix(front > 0 ? front : 1);
  }
  return out;
}

}  // namespace racebeam

#include "system/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "system/similar.hpp"

namespace racebeam {
namespace {

bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

template <typename Number>
void append_any(std::string& out, Number number) {
  std::array<char, 32> digits;
  const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  out.append(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

}  // namespace

std::string_view next_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(word.size());
  return word;
}

void split(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (auto word = next_word(line); !word.empty(); word = next_word(line)) words.push_back(word);
}

std::int64_t number_within(std::string_view text, std::string_view what, std::int64_t least,
                           std::int64_t most) {
  const auto number = parse_number<std::int64_t>(text);
  const bool is_minus_zero = number == 0 && text.starts_with('-');  // most likely the client's mistake
  if (number && !is_minus_zero && *number >= least && *number <= most) return *number;
  throw InvalidInput(std::string(what) + " is " + quote(text) + "; it takes a whole number from " +
                     std::to_string(least) + " to " + std::to_string(most));
}

KeyValue key_value(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals != std::string_view::npos) return {word.substr(0, equals), word.substr(equals + 1)};
  throw InvalidArguments(quote(word) + " is not of the form key=value");
}

std::string_view value_of(std::string_view word, std::string_view key, std::string_view command) {
  if (word.size() > key.size() && word.starts_with(key) && word[key.size()] == '=')
    return word.substr(key.size() + 1);
  throw InvalidArguments(quote(word) + " is not accepted here; " + std::string(command) + " takes " +
                         std::string(key) + "=");
}

std::string advice(std::string_view name, Words names, std::string accepted) {
  const std::string similar = did_you_mean(name, names);
  if (!similar.empty())
    accepted[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(accepted[0])));
  return similar + ' ' + accepted;
}

std::string unknown_name(std::string_view kind, std::string_view name, Words names) {
  std::string list = "accepted:";
  for (const std::string_view one : names) (list += ' ') += one;
  return "unknown " + std::string(kind) + ' ' + quote(name) + ';' + advice(name, names, list);
}

void refuse_name(std::string_view kind, std::string_view name, Words names) {
  throw InvalidArguments(unknown_name(kind, name, names));
}

std::size_t choice_of(std::string_view value, std::string_view what, Words accepted) {
  const auto found = std::ranges::find(accepted, value);
  if (found != accepted.end()) return static_cast<std::size_t>(found - accepted.begin());
  std::string list = "it takes ";
  for (const std::string_view& one : accepted) {
    if (&one != &accepted.front()) list += &one == &accepted.back() ? " or " : ", ";
    list += one;
  }
  throw InvalidInput(std::string(what) + " is " + quote(value) + ';' + advice(value, accepted, list));
}

void refuse_twice(std::string_view key) { throw InvalidArguments(std::string(key) + " is given twice"); }

std::string_view cut_behind(std::string_view& text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = text.substr(at + 1);
  text = text.substr(0, at);
  return rest;
}

std::string_view checked_name(std::string_view text, std::string_view what) {
  constexpr std::size_t kLongestName = 64;
  if (!text.empty() && text.size() <= kLongestName && std::ranges::all_of(text, is_name_letter)) return text;
  throw InvalidInput(quote(text) + " is not a name for a " + std::string(what) +
                     "; it takes 1 to 64 letters, digits, - and _");
}

std::vector<std::uint8_t> bytes_of_hex(std::string_view digits) {
  std::vector<std::uint8_t> bytes(digits.size() / 2);
  bool good = digits.size() % 2 == 0;
  for (std::size_t i = 0; good && i < bytes.size(); ++i) {
    const char* const pair = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(pair, pair + 2, bytes[i], 16);
    good = error == std::errc{} && end == pair + 2;
  }
  if (!good) throw InvalidInput(quote(digits) + " are not hexadecimal bytes, two digits each");
  return bytes;
}

void append_number(std::string& out, std::int64_t number) { append_any(out, number); }
void append_number(std::string& out, double number) { append_any(out, number); }

void append_list(std::string& out, std::span<const int> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) out += ',';
    append_number(out, std::int64_t{numbers[i]});
  }
}

void append_pair(std::string& out, std::string_view key, std::int64_t number) {
  ((out += ' ') += key) += '=';
  append_number(out, number);
}

void append_pair(std::string& out, std::string_view key, std::string_view text) {
  (((out += ' ') += key) += '=') += text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

std::string quote(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string sentence = "'";
  sentence += text.substr(0, kShown);
  return sentence += text.size() <= kShown ? "'" : "...'";
}

}  // namespace racebeam

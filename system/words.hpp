// Splits a line into words, and reads words: numbers, lists, key=value. A word that is refused is an
// InvalidInput, or an InvalidArguments, whose message quotes it.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/invalid_input.hpp"
#include "system/named_rows.hpp"

namespace racebeam {

using Words = std::span<const std::string_view>;

// Splits at blanks; several in a row count as one. Reuses the memory of `words`.
void split(std::string_view line, std::vector<std::string_view>& words);
std::string_view next_word(std::string_view& line);  // removes it from the line; empty: the line has no more

// The whole text as a number; nothing for any other text, including "nan" and "inf".
template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end || text.empty()) return std::nullopt;
  if constexpr (std::floating_point<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

// A whole number from `least` to `most`. Throws InvalidInput, which names it `what`.
std::int64_t number_within(std::string_view text, std::string_view what, std::int64_t least,
                           std::int64_t most);

struct KeyValue {
  std::string_view key, value;
};
// Throws InvalidArguments if the word lacks '='.
KeyValue key_value(std::string_view word);

// The value of key=value, if `command` accepts only this key. Throws InvalidArguments.
std::string_view value_of(std::string_view word, std::string_view key, std::string_view command);

// The end of an error: a suggestion, if a name is similar, then what is accepted. `accepted` begins with a
// small letter. The result is " did you mean A? Accepted: A B C", or " accepted: A B C".
std::string advice(std::string_view name, Words names, std::string accepted);

// "unknown KIND 'NAME'; did you mean A? Accepted: A B C"
std::string unknown_name(std::string_view kind, std::string_view name, Words names);
[[noreturn]] void refuse_name(std::string_view kind, std::string_view name, Words names);  // InvalidArguments

// The index of `value` in `accepted`. Throws InvalidInput: "WHAT is 'VALUE'; did you mean A? It
// takes A, B or C".
std::size_t choice_of(std::string_view value, std::string_view what, Words accepted);

// A word of a request or of a file, and the value that it stands for.
template <typename Value>
struct WordFor {
  std::string_view name;
  Value value;
};

template <typename Rows, typename Value>
constexpr std::string_view word_for(const Rows& rows, Value value) {
  for (const auto& row : rows)
    if (row.value == value) return row.name;
  return {};
}

// The value of `word`. Throws like choice_of().
template <typename Rows>
auto value_for(std::string_view word, std::string_view what, const Rows& rows) {
  return rows[choice_of(word, what, names_of(rows))].value;
}

[[noreturn]] void refuse_twice(std::string_view key);  // InvalidArguments

// Removes the first `mark` and the text after it from `text`. Returns the text after the mark; "" if there is
// no mark.
std::string_view cut_behind(std::string_view& text, char mark);

// A name for something that a client saves: 1 to 64 letters, digits, '-' and '_'. Throws
// InvalidInput.
std::string_view checked_name(std::string_view text, std::string_view what);

std::vector<std::uint8_t> bytes_of_hex(std::string_view digits);  // throws InvalidInput

void append_number(std::string& out, std::int64_t number);
void append_number(std::string& out, double number);               // the shortest text that reads back
void append_list(std::string& out, std::span<const int> numbers);  // 0,1,2

// " key=number", " key=text"
void append_pair(std::string& out, std::string_view key, std::int64_t number);
void append_pair(std::string& out, std::string_view key, std::string_view text);

// For messages: the user's text, shortened if it is long.
std::string quote(std::string_view text);

// ASCII letters in lower and in upper case; other bytes stay.
std::string lower_case(std::string_view text);
std::string upper_case(std::string_view text);

// One text of all words, with `between` after each but the last two, which have `last` between them.
template <typename Texts>
std::string join(const Texts& words, std::string_view between, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    (text += i == 0 ? "" : i + 1 == words.size() ? last : between) += words[i];
  return text;
}

template <typename Texts>
std::string join(const Texts& words, std::string_view between) {
  return join(words, between, between);
}

}  // namespace racebeam

/// @file
/// The words of a request. Any thread may call these functions.
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <ranges>
#include <string>
#include <string_view>

#include "racebeam/client/config.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

namespace detail {

template <class Number>
requires std::integral<Number> || std::floating_point<Number> std::string to_text(Number number) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}
inline std::string to_text(bool value) { return value ? "1" : "0"; }
inline std::string to_text(std::string_view text) { return std::string(text); }
inline std::string to_text(const char* text) { return text; }
inline std::string to_text(const std::string& text) { return text; }

}  // namespace detail

/// KEY=VALUE of a request. The value is a text, a number or a bool.
class Setting {
 public:
  /// Such as `Setting("sticky", 0.25)`.
  template <class Value>
  Setting(std::string_view key, const Value& value)
      : text_(std::string(key).append("=").append(detail::to_text(value))) {}

  /// The word as the client sends it.
  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

namespace detail {

inline void append_words(std::string& line, const Setting& setting) {
  line.append(" ").append(setting.text());
}

/// Appends a word, or each word of a range.
template <class Word>
void append_words(std::string& line, const Word& word) {
  if constexpr (requires { to_text(word); }) {
    line.append(" ").append(to_text(word));
  } else {
    for (const auto& each : word) append_words(line, each);
  }
}

/// A request. Each word is a text, a number, a Setting, or a range of these.
template <class... Words>
std::string request_line(std::string_view command, const Words&... words) {
  std::string line(command);
  (append_words(line, words), ...);
  return line;
}

}  // namespace detail
}  // namespace RACEBEAM_CLIENT_NAMESPACE

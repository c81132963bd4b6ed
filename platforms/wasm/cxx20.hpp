// What the sources use of C++20's library and libc++ 13, which comes with Debian's Emscripten, lacks. The
// compiler includes this file before each source. A newer libc++ makes it empty.
#pragma once

#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace std {

template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

class jthread : public thread {
 public:
  using thread::thread;
  jthread(jthread&&) noexcept = default;
  jthread& operator=(jthread&&) noexcept = default;
  ~jthread() {
    if (joinable()) join();
  }
};

// Both use the C locale, which programs of racebeam do not change.
inline to_chars_result to_chars(char* first, char* last, float value, chars_format, int precision) {
  char text[32];
  const int size = snprintf(text, sizeof text, "%.*g", precision, static_cast<double>(value));
  if (size > last - first) return {last, errc::value_too_large};
  return {static_cast<char*>(memcpy(first, text, static_cast<size_t>(size))) + size, errc{}};
}

template <typename Number>
requires is_floating_point_v<Number> from_chars_result from_chars(const char* first, const char* last,
                                                                  Number& value) {
  // Hexadecimal numbers end at their x.
  const string text(first, find_if(first, last, [](char c) { return c == 'x' || c == 'X'; }));
  if (text.empty() || !strchr("-.0123456789in", text[0])) return {first, errc::invalid_argument};
  char* end = nullptr;
  const Number number = is_same_v<Number, float> ? static_cast<Number>(strtof(text.c_str(), &end))
                                                 : static_cast<Number>(strtod(text.c_str(), &end));
  if (end == text.c_str()) return {first, errc::invalid_argument};
  if (!isfinite(number) && text.find_first_of("0123456789") != string::npos)
    return {end - text.c_str() + first, errc::result_out_of_range};
  value = number;
  return {first + (end - text.c_str()), errc{}};
}

// The shortest text that reads back; of 1e-04 and 0.0001 the latter, where other libraries choose the former.
template <typename Number>
requires is_floating_point_v<Number> to_chars_result to_chars(char* first, char* last, Number value) {
  char text[32];
  int size = 0;
  for (int precision = 1; precision <= 17; ++precision) {
    size = snprintf(text, sizeof text, "%.*g", precision, static_cast<double>(value));
    Number back{};
    from_chars(text, text + size, back);
    if (back == value) break;
  }
  if (size > last - first) return {last, errc::value_too_large};
  return {static_cast<char*>(memcpy(first, text, static_cast<size_t>(size))) + size, errc{}};
}

namespace ranges {

template <typename In, typename Out>
struct in_out_result {
  In in;
  Out out;
};

template <typename Range, typename Test, typename Projection = identity>
constexpr auto find_if(Range&& range, Test test, Projection project = {}) {
  auto at = std::begin(range);
  while (at != std::end(range) && !invoke(test, invoke(project, *at))) ++at;
  return at;
}

template <typename Range, typename Value, typename Projection = identity>
constexpr auto find(Range&& range, const Value& value, Projection project = {}) {
  return ranges::find_if(
      range, [&](const auto& found) { return found == value; }, project);
}

template <typename Range, typename Test>
constexpr bool any_of(Range&& range, Test test) {
  return ranges::find_if(range, test) != std::end(range);
}

template <typename Range, typename Test>
constexpr bool none_of(Range&& range, Test test) {
  return !ranges::any_of(range, test);
}

template <typename Range, typename Test>
constexpr bool all_of(Range&& range, Test test) {
  return !ranges::any_of(range, [&](const auto& value) { return !invoke(test, value); });
}

template <typename Range, typename Value>
constexpr auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}

template <typename Range, typename Test>
constexpr auto count_if(Range&& range, Test test) {
  return std::count_if(std::begin(range), std::end(range), test);
}

template <typename One, typename Other, typename Test = std::equal_to<>>
constexpr bool equal(One&& one, Other&& other, Test test = {}) {
  return std::equal(std::begin(one), std::end(one), std::begin(other), std::end(other), test);
}

template <typename One, typename Other>
constexpr bool includes(One&& one, Other&& other) {
  return std::includes(std::begin(one), std::end(one), std::begin(other), std::end(other));
}

template <typename Range>
constexpr auto max(Range&& range) {
  return *std::max_element(std::begin(range), std::end(range));
}

template <typename Order, typename Projection>
constexpr auto ordered_by(Order& order, Projection& project) {
  return [&](const auto& a, const auto& b) { return invoke(order, invoke(project, a), invoke(project, b)); };
}

template <typename Range, typename Order = std::less<>, typename Projection = identity>
constexpr auto min_element(Range&& range, Order order = {}, Projection project = {}) {
  return std::min_element(std::begin(range), std::end(range), ordered_by(order, project));
}

template <typename Range, typename Order = std::less<>, typename Projection = identity>
constexpr void sort(Range&& range, Order order = {}, Projection project = {}) {
  std::sort(std::begin(range), std::end(range), ordered_by(order, project));
}

template <typename Range, typename Value, typename Order = std::less<>, typename Projection = identity>
constexpr auto lower_bound(Range&& range, const Value& value, Order order = {}, Projection project = {}) {
  const auto is_before = [&](const auto& a, const auto& b) { return invoke(order, invoke(project, a), b); };
  return std::lower_bound(std::begin(range), std::end(range), value, is_before);
}

template <typename Range, typename Value>
constexpr auto upper_bound(Range&& range, const Value& value) {
  return std::upper_bound(std::begin(range), std::end(range), value);
}

template <typename Range, typename Out>
constexpr auto copy(Range&& range, Out out) {
  auto at = std::begin(range);
  for (; at != std::end(range); ++at, ++out) *out = *at;
  return in_out_result<decltype(at), Out>{at, out};
}

template <typename In, typename Size, typename Out>
constexpr auto copy_n(In in, Size count, Out out) {
  for (; count > 0; --count, ++in, ++out) *out = *in;
  return in_out_result<In, Out>{in, out};
}

template <typename Range, typename Out, typename Function>
constexpr void transform(Range&& range, Out out, Function function) {
  for (auto&& value : range) *out++ = invoke(function, value);
}

template <typename One, typename Other, typename Out, typename Function>
constexpr void transform(One&& one, Other&& other, Out out, Function function) {
  auto second = std::begin(other);
  for (auto&& value : one) *out++ = invoke(function, value, *second++);
}

template <typename Range, typename Value>
constexpr void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}

template <typename Range, typename Test, typename Value>
constexpr void replace_if(Range&& range, Test test, const Value& value) {
  for (auto& old : range)
    if (invoke(test, old)) old = value;
}

template <typename Range, typename Value>
constexpr void replace(Range&& range, const Value& old, const Value& value) {
  std::replace(std::begin(range), std::end(range), old, value);
}

}  // namespace ranges
}  // namespace std
#endif

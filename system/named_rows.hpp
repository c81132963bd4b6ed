// Tables whose rows have a name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <vector>

namespace racebeam {

template <typename Rows>
std::vector<std::string_view> names_of(const Rows& rows) {
  std::vector<std::string_view> names;
  names.reserve(std::size(rows));
  for (const auto& row : rows) names.push_back(row.name);
  return names;
}

// Returns what names_of() does, as a constant.
template <typename Row, std::size_t kRows>
constexpr std::array<std::string_view, kRows> name_array(const std::array<Row, kRows>& rows) {
  std::array<std::string_view, kRows> names;
  std::ranges::transform(rows, names.begin(), [](const Row& row) { return row.name; });
  return names;
}

// Returns the row of this name. If a constant is made of it, a missing row is an error of compilation. It is
// not consteval because of a fault in Clang 14: a captureless lambda that is passed to an immediate function
// loses its arguments.
template <typename Rows>
constexpr const auto& row_named(const Rows& rows, std::string_view name) {
  for (const auto& row : rows)
    if (row.name == name) return row;
  throw "unknown row";
}

// Whether two tables have the same names, in the same order.
template <typename One, typename Other>
consteval bool same_names(const One& one, const Other& other) {
  return std::ranges::equal(one, other, [](const auto& a, const auto& b) { return a.name == b.name; });
}

}  // namespace racebeam

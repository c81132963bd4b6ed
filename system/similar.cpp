#include "system/similar.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "system/words.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kSuggestions = 3;
constexpr std::size_t kLongest = 64;  // letters; a longer name is not similar to any

// The Levenshtein distance: how many letters to insert, delete or replace.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string_view> similar_names(std::string_view name,
                                            std::span<const std::string_view> candidates) {
  if (name.empty() || name.size() > kLongest) return {};
  const std::string small = lower_case(name);
  const std::size_t farthest = std::max<std::size_t>(2, name.size() / 3);
  std::vector<std::pair<std::size_t, std::string_view>> near;
  for (const std::string_view one : candidates) {
    const std::string other = lower_case(one);
    const bool begins_alike = small.size() > 2 && other != small && other.starts_with(small);
    const std::size_t distance = begins_alike ? 1 : edit_distance(small, other);
    if (distance <= farthest && distance < std::min(name.size(), one.size()))
      near.emplace_back(distance, one);
  }
  std::ranges::sort(near);
  std::vector<std::string_view> names;
  for (const auto& [distance, one] : near) {
    if (names.size() < kSuggestions && distance <= near[0].first + 1) names.push_back(one);
  }
  return names;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
  std::string question;
  for (const std::string_view one : similar_names(name, candidates))
    (question += question.empty() ? " did you mean " : " or ") += one;
  return question.empty() ? question : question + '?';
}

}  // namespace racebeam

#include "recording/result_row.hpp"

#include <algorithm>
#include <vector>

#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

std::string hex_of(std::uint64_t hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text(16, '0');
  for (auto at = text.rbegin(); at != text.rend(); ++at, hash >>= 4) *at = kDigits[hash & 15];
  return text;
}

std::string_view seed_of(std::string_view settings) {
  std::vector<std::string_view> words;
  split(settings, words);
  for (const std::string_view word : words)
    if (word.starts_with("seed=")) return word.substr(5);
  return "";
}

std::size_t place_of(std::string_view column) {
  return static_cast<std::size_t>(std::ranges::find(kResultColumns, column) - kResultColumns.begin());
}

}  // namespace

std::string line_of(const ResultRow& row) {
  std::string line = row[0];
  for (std::size_t i = 1; i < row.size(); ++i) (line += ',') += row[i];
  return line + "\n";
}

ResultRow row_of(const EpisodeLog& log, const std::string& digest) {
  return {log.origin.unit,
          log.game,
          log.image_md5,
          log.origin.agent,
          std::to_string(log.origin.trial),
          std::to_string(log.origin.episode),
          std::string(seed_of(log.settings)),
          std::to_string(log.origin.agent_seed),
          std::to_string(log.end.score),
          std::to_string(log.end.frames),
          std::to_string(log.end.decisions),
          std::string(name_of(log.end.over)),
          std::to_string(log.end.lives),
          hex_of(log.hashes.back()),
          digest,
          log.origin.version};
}

ResultRow row_of_line(std::string_view line) {
  const auto fields = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
  ResultRow row;
  if (fields != row.size())
    throw InvalidInput("the row has " + std::to_string(fields) + (fields == 1 ? " field" : " fields") +
                       "; a row takes " + std::to_string(row.size()));
  for (std::string& value : row) {
    const std::string_view rest = cut_behind(line, ',');
    value = line;
    line = rest;
  }
  return row;
}

const std::string& field(const ResultRow& row, std::string_view column) { return row.at(place_of(column)); }
std::string& field(ResultRow& row, std::string_view column) { return row.at(place_of(column)); }

}  // namespace racebeam

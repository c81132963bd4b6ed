#include "agents/experiment/results.hpp"

#include <algorithm>

#include "protocol/line/words.hpp"
#include "system/invalid_input.hpp"

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

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  for (std::size_t from = 0;;) {
    const std::size_t comma = line.find(',', from);
    fields.emplace_back(line.substr(from, comma - from));
    if (comma == std::string_view::npos) return fields;
    from = comma + 1;
  }
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

ResultRow row_of_plan(const Plan& plan, const Unit& unit, int episode) {
  ResultRow row;
  field(row, "unit") = unit.name;
  field(row, "game") = unit.game->name;
  field(row, "image_md5") = unit.game->image_md5;
  field(row, "agent") = unit.agent_name;
  field(row, "trial") = std::to_string(unit.trial);
  field(row, "episode") = std::to_string(episode);
  field(row, "environment_seed") = std::to_string(environment_seed(plan, unit, false, episode));
  field(row, "agent_seed") = std::to_string(agent_seed(plan, unit));
  field(row, "version") = plan.version;
  return row;
}

ResultRow row_of_divergence(const Plan& plan, const Unit& unit) {
  ResultRow row = row_of_plan(plan, unit, 0);
  field(row, "environment_seed") = "";
  field(row, "end") = "diverged";
  return row;
}

std::string curve_line(const Unit& unit, int episode, const EpisodeEnd& end) {
  std::string line = unit.name + ',' + unit.game->name + ',' + unit.agent_name;
  for (const std::int64_t number :
       {std::int64_t{unit.trial}, std::int64_t{episode}, end.score, end.frames, end.decisions})
    (line += ',') += std::to_string(number);
  return line + "\n";
}

namespace {

std::size_t place_of(std::string_view column) {
  return static_cast<std::size_t>(std::ranges::find(kResultColumns, column) - kResultColumns.begin());
}

}  // namespace

const std::string& field(const ResultRow& row, std::string_view column) { return row.at(place_of(column)); }
std::string& field(ResultRow& row, std::string_view column) { return row.at(place_of(column)); }

std::vector<ResultRow> parse_results(const std::string& name, std::string_view text) {
  const std::string columns = line_of(kResultColumns);
  if (!text.starts_with(columns))
    throw InvalidInput(name + ": its first line must name the columns " +
                       columns.substr(0, columns.size() - 1));
  std::vector<ResultRow> rows;
  std::size_t line = 2;
  for (text.remove_prefix(columns.size()); !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos)
      throw InvalidInput(name + ":" + std::to_string(line) +
                         ": the last line does not end; the file was cut");
    const std::vector<std::string> fields = fields_of(text.substr(0, end));
    if (fields.size() != kResultColumns.size())
      throw InvalidInput(name + ":" + std::to_string(line) + ": the row has " +
                         std::to_string(fields.size()) + " fields; there are " +
                         std::to_string(kResultColumns.size()) + " columns");
    std::ranges::copy(fields, rows.emplace_back().begin());
    text.remove_prefix(end + 1);
  }
  return rows;
}

}  // namespace racebeam

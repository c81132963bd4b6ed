#include "agents/experiment/results.hpp"

#include <algorithm>
#include <vector>

#include "system/input_file.hpp"
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

ResultRow row_of_line(std::string_view line, const auto& refuse) {
  const auto fields = static_cast<std::size_t>(std::ranges::count(line, ',')) + 1;
  ResultRow row;
  if (fields != row.size())
    refuse("the row has " + std::to_string(fields) + " fields; accepted: " + std::to_string(row.size()) +
           " columns");
  for (std::string& value : row) {
    const std::size_t comma = std::min(line.find(','), line.size());
    value = line.substr(0, comma);
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  return row;
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

std::string_view name_of(Role role) {
  switch (role) {
    case Role::kBaseline: return "baseline";
    case Role::kLearner: return "learner";
    case Role::kPlanner: return "planner";
  }
  return "";
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

void each_result(const std::string& path, const RowVisitor& visit) {
  constexpr std::size_t kMostLineBytes = 1 << 16;
  const std::string columns = line_of(kResultColumns);
  std::size_t number = 0;
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput("results.csv:" + std::to_string(number) + ": " + reason);
  };
  const auto check_columns = [&](std::string_view line) {
    if (line != std::string_view(columns).substr(0, columns.size() - 1))
      throw InvalidInput("results.csv: its first line must name the columns " +
                         columns.substr(0, columns.size() - 1));
  };
  each_line("results", path, kMostLineBytes, [&](std::string_view line, bool ends) {
    if (++number == 1) check_columns(line);
    if (!ends) refuse("the last line does not end; the file was cut");
    if (number > 1) visit(row_of_line(line, refuse), number);
  });
  if (number == 0) check_columns("");
}

}  // namespace racebeam

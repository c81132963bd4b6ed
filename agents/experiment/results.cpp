#include "agents/experiment/results.hpp"

#include <algorithm>
#include <vector>

#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {

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

void each_result(const std::string& path, const RowVisitor& visit) {
  constexpr std::size_t kMaxLineBytes = 1 << 16;
  const std::string columns = line_of(kResultColumns);
  std::size_t number = 0;
  const auto refuse = [&](const std::string& reason) {
    throw InvalidInput("results.csv:" + std::to_string(number) + ": " + reason);
  };
  const auto read = [&](std::string_view line) {
    try {
      return row_of_line(line);
    } catch (const InvalidInput& error) {
      refuse(error.what());
      throw;
    }
  };
  const auto check_columns = [&](std::string_view line) {
    if (line != std::string_view(columns).substr(0, columns.size() - 1))
      throw InvalidInput("results.csv: its first line must name the columns " +
                         columns.substr(0, columns.size() - 1));
  };
  each_line("results", path, kMaxLineBytes, [&](std::string_view line, bool ends) {
    if (line.ends_with('\r')) line.remove_suffix(1);  // a file that was edited on Windows
    if (++number == 1) check_columns(line);
    if (!ends) refuse("the last line does not end; the file was cut");
    if (number > 1) visit(read(line), number);
  });
  if (number == 0) check_columns("");
}

}  // namespace racebeam

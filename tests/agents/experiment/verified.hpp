// Results to be verified, altered and verified again.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "agents/experiment/verify.hpp"
#include "recording/sha256.hpp"
#include "tests/agents/experiment/samples.hpp"

namespace racebeam::test {

inline constexpr auto kPlan = R"(games = ["beamfall"]
agents = ["random", "perturb", "basic"]
trials = 1
training_episodes = 2
evaluation_episodes = 2
background_screens = 300
environment = "max_episode_frames=1000"
)";

struct Verified {
  Verdict verdict;
  std::string findings;
};

inline Verified verified(const ResultsFolder& folder, const Images& images = Images()) {
  Verified result;
  result.verdict = verify(folder, images, 2, CpuKind::kAuto,
                          [&](const std::string& line) { result.findings += line + "\n"; });
  return result;
}

// `table` with another value; `line` counts rows from 0.
inline std::string altered_field(const std::string& table, std::size_t line, std::size_t column,
                                 const std::string& value) {
  std::vector<ResultRow> rows = rows_of(table);
  rows.at(line).at(column) = value;
  std::string text = line_of(kResultColumns);
  for (const ResultRow& row : rows) text += line_of(row);
  return text;
}

// Alters the log of a row, seals it again, and makes the row fit.
inline void reseal(const ResultsFolder& folder, std::size_t line,
                   const std::function<void(EpisodeLog& log)>& alter) {
  std::vector<ResultRow> rows = rows_of(contents(folder.results()));
  ResultRow& row = rows.at(line);
  const std::string path = folder.log(row[0], field(row, "episode"));
  EpisodeLog log = log_of(path, contents(path));
  alter(log);
  const std::string bytes = bytes_of(log);
  write(path, bytes);
  row = row_of(log, sha256_of(bytes));
  std::string text = line_of(kResultColumns);
  for (const ResultRow& each : rows) text += line_of(each);
  write(folder.results(), text);
}

}  // namespace racebeam::test

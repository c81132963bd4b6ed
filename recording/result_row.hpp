// The rows of results.csv, and of the other tables of results (docs/episodes.md, "The tables").
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "recording/episode_log.hpp"

namespace racebeam {

// The columns of results.csv: a row for each evaluation episode, in the plan's order. evaluation/ reads them.
// A trial that diverged has one row, with end=diverged, episode 0, and no score, hash or digest.
constexpr std::array<std::string_view, 16> kResultColumns = {
    "unit",  "game",   "image_md5", "agent", "trial", "episode",    "environment_seed", "agent_seed",
    "score", "frames", "decisions", "end",   "lives", "state_hash", "log_digest",       "version"};
using ResultRow = std::array<std::string, kResultColumns.size()>;

template <std::size_t kSize>
std::string line_of(const std::array<std::string_view, kSize>& columns) {
  std::string line;
  for (const std::string_view column : columns) (line += line.empty() ? "" : ",") += column;
  return line + "\n";
}

std::string line_of(const ResultRow& row);

// The row of this log. `digest` is the digest of the log's bytes.
ResultRow row_of(const EpisodeLog& log, const std::string& digest);

ResultRow row_of_line(std::string_view line);  // throws InvalidInput

// The value of a column, by its name.
const std::string& field(const ResultRow& row, std::string_view column);
std::string& field(ResultRow& row, std::string_view column);

}  // namespace racebeam

// The tables of an experiment's results, and where everything lies in its folder (docs/experiments.md).
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>

#include "agents/experiment/plan.hpp"
#include "recording/result_row.hpp"

namespace racebeam {

// The columns of curves.csv: a row for each training episode.
constexpr std::array<std::string_view, 8> kCurveColumns = {"unit",    "game",  "agent",  "trial",
                                                           "episode", "score", "frames", "decisions"};

// The columns of times.csv. They differ from run to run, and are kept apart for that.
constexpr std::array<std::string_view, 6> kTimeColumns = {
    "unit",           "training_seconds", "training_frames", "evaluation_seconds", "evaluation_frames",
    "searched_frames"};

// The columns of agents.csv: a row for each agent of results.csv, in the plan's order.
constexpr std::array<std::string_view, 2> kAgentColumns = {"agent", "role"};
std::string_view name_of(Role role);  // "learner", "planner" or "baseline"

// Return the row of an episode, and that of a trial that diverged, as far as the plan determines them. The
// other columns are empty.
ResultRow row_of_plan(const Plan& plan, const Unit& unit, int episode);
ResultRow row_of_divergence(const Plan& plan, const Unit& unit);

std::string curve_line(const Unit& unit, int episode, const EpisodeEnd& end);

// Calls visit() with each row of results.csv and the number of its line. Only one row is in memory at a time.
// Throws InvalidInput if a column is missing or wrong, or a row does not have the columns.
using RowVisitor = std::function<void(const ResultRow& row, std::size_t line)>;
void each_result(const std::string& path, const RowVisitor& visit);

// Paths in a folder of results.
class ResultsFolder {
 public:
  explicit ResultsFolder(std::string root) : root_(std::move(root)) {}

  const std::string& root() const { return root_; }
  std::string plan() const { return root_ + "/plan.toml"; }
  std::string results() const { return root_ + "/results.csv"; }
  std::string curves() const { return root_ + "/curves.csv"; }
  std::string times() const { return root_ + "/times.csv"; }
  std::string agents() const { return root_ + "/agents.csv"; }
  std::string units() const { return root_ + "/units"; }  // finished ones
  std::string unit(const std::string& name, std::string_view table) const {
    return (units() + '/' + name + '.').append(table) + ".csv";
  }
  std::string logs() const { return root_ + "/logs"; }
  std::string logs(const std::string& unit) const { return logs() + '/' + unit; }
  std::string log(const std::string& unit, const std::string& episode) const {
    return logs(unit) + '/' + episode + ".episode";
  }
  std::string facts() const { return root_ + "/games"; }  // backgrounds and classes
  std::string work() const { return root_ + "/work"; }    // removed when all units are finished
  std::string checkpoint(const std::string& unit) const { return work() + '/' + unit + ".checkpoint"; }
  std::string lock(const std::string& name) const { return work() + '/' + name + ".lock"; }

 private:
  std::string root_;
};

}  // namespace racebeam

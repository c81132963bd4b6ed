// The common part of the two ways to verify results. Rows are judged on several threads, some thousands at a
// time; their verdicts are reported and counted in the order of the table.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "agents/experiment/log_judge.hpp"
#include "agents/experiment/verify.hpp"
#include "environment/vector/thread_pool.hpp"

namespace racebeam {

// "results.csv:2 (pong-uct-1, episode 1)"
std::string name_of_row(const ResultRow& row, std::size_t line);

class RowTally {
 public:
  using Judge = std::function<RowVerdict()>;

  RowTally(unsigned threads, const FindingCallback& finding) : pool_(threads), finding_(finding) {}

  unsigned threads() const { return pool_.threads(); }

  // `judge` runs later, on any thread. What it throws is the reason why the row is wrong.
  void add_row(std::string name, Judge judge);
  // A row that need not be judged: `line` says what is wrong with it.
  void add_wrong_row(std::string line);
  // Counts and reports something wrong that is not a row, after the rows that were taken before.
  void add_wrong(const std::string& line);
  // Counts a row that cannot be judged. Reports `line` unless it is empty.
  void add_unchecked(const std::string& line);
  // Counts each file below `logs` as wrong for which is_expected() returns false.
  void find_surplus(const std::string& logs,
                    const std::function<bool(const std::string& path, bool is_folder)>& is_expected);

  Verdict verdict();

 private:
  struct PendingRow {
    std::string name;  // if `judge` is empty: what is wrong with the row
    Judge judge;
    RowVerdict found;
  };

  void judge_pending();
  void count(const PendingRow& one);

  ThreadPool pool_;
  const FindingCallback& finding_;
  std::vector<PendingRow> pending_;
  Verdict verdict_;
};

// Throws InvalidInput: a link could lead to any folder of the system.
void refuse_link(const std::string& path);
bool is_link(const std::string& path);

}  // namespace racebeam

#include "agents/experiment/row_tally.hpp"

#include <filesystem>
#include <set>
#include <system_error>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kRowsAtATime = 4096;  // in memory

RowVerdict verdict_of(const RowTally::Judge& judge) {
  try {
    return judge();
  } catch (const std::exception& error) {
    return {Judgement::kWrong, error.what()};
  }
}

void check_listing(const std::string& folder, const std::error_code& error) {
  if (error) throw InvalidInput(folder + ": the folder cannot be listed: " + error.message());
}

}  // namespace

std::string name_of_row(const ResultRow& row, std::size_t line) {
  return "results.csv:" + std::to_string(line) + " (" + row[0] + ", episode " + field(row, "episode") + ")";
}

void RowTally::add_row(std::string name, Judge judge) {
  pending_.push_back({std::move(name), std::move(judge), {}});
  if (pending_.size() == kRowsAtATime) judge_pending();
}

void RowTally::add_wrong_row(std::string line) { add_row(std::move(line), nullptr); }

void RowTally::add_wrong(const std::string& line) {
  judge_pending();
  ++verdict_.wrong;
  finding_(line);
}

void RowTally::add_unchecked(const std::string& line) {
  judge_pending();
  ++verdict_.unchecked;
  if (!line.empty()) finding_(line);
}

void RowTally::find_surplus(const std::string& logs,
                            const std::function<bool(const std::string& path, bool is_folder)>& is_expected) {
  namespace fs = std::filesystem;
  std::set<std::string> surplus;
  std::error_code none, error;
  fs::recursive_directory_iterator entry(logs, error);
  if (error == std::errc::no_such_file_or_directory) return;  // each row says that its log is missing
  check_listing(logs, error);
  while (entry != fs::recursive_directory_iterator()) {
    const std::string path = entry->path().generic_string();  // with /, as the names of rows
    if (!is_expected(path, entry->is_directory(none))) surplus.insert(path);
    entry.increment(error);
    check_listing(path, error);
  }
  for (const std::string& path : surplus) add_wrong(path + ": no row of results.csv has this log");
}

Verdict RowTally::verdict() {
  judge_pending();
  return verdict_;
}

void RowTally::judge_pending() {
  pool_.run(pending_.size(), [&](std::size_t i) {
    if (PendingRow& one = pending_[i]; one.judge) one.found = verdict_of(one.judge);
  });
  for (const PendingRow& one : pending_) count(one);
  pending_.clear();
}

void RowTally::count(const PendingRow& one) {
  verdict_.frames += one.found.frames;
  if (one.judge && one.found.judgement == Judgement::kConfirmed) {
    ++verdict_.confirmed;
    return;
  }
  const bool is_wrong = !one.judge || one.found.judgement == Judgement::kWrong;
  ++(is_wrong ? verdict_.wrong : verdict_.unchecked);
  if (!one.judge) return finding_(one.name);
  finding_(one.name + (is_wrong ? ": not confirmed: " : ": could not be checked: ") + one.found.reason);
}

bool is_link(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_symlink(std::filesystem::symlink_status(path, none));
}

void refuse_link(const std::string& path) {
  if (is_link(path))
    throw InvalidInput(path + ": this is a link, which is not followed; accepted is a folder");
}

}  // namespace racebeam

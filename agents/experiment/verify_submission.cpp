#include "agents/experiment/verify_submission.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "agents/base/sealed_file.hpp"
#include "agents/experiment/log_judge.hpp"
#include "environment/vector/thread_pool.hpp"
#include "protocol/line/words.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRowsInMemory = 4096;
constexpr std::size_t kLongestName = 100;

// Whether a name is that of a file, and leads nowhere else.
bool is_plain(std::string_view name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !name.empty() && name.size() <= kLongestName && is_letter(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return is_letter(c) || c == '_' || c == '.' || c == '-'; });
}

bool is_link(const std::string& path) {
  std::error_code none;
  return fs::is_symlink(fs::symlink_status(path, none));
}

// The settings of a log without the seed.
std::string settings_without_seed(const EpisodeLog& log) {
  std::vector<std::string_view> words;
  split(log.settings, words);
  std::ranges::sort(words);
  std::string text;
  for (const std::string_view word : words)
    if (key_value(word).key != "seed") (text += text.empty() ? "" : " ") += word;
  return text;
}

class SubmissionJudge {
 public:
  SubmissionJudge(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu)
      : folder_(folder), logs_(images, threads, cpu) {}

  RowVerdict judge(const ResultRow& row) {
    if (field(row, "end") == "diverged")
      return {Judgement::kUnchecked, "the trial diverged; there is no episode to play"};
    try {
      return judge_episode(row);
    } catch (const std::exception& error) {
      return {Judgement::kWrong, error.what()};
    }
  }

  // All logs must have the settings of the first row's. Called before judge().
  void take_settings(const ResultRow& row) {
    try {
      settings_ = settings_without_seed(log_of_row(row).first);
    } catch (const std::exception&) {  // judge() says what is wrong
    }
  }
  bool has_settings() const { return settings_.has_value(); }

 private:
  std::pair<EpisodeLog, std::string> log_of_row(const ResultRow& row) const {
    const std::string path = folder_.log(row[0], field(row, "episode"));
    if (is_link(folder_.logs(row[0])) || is_link(path))
      throw InvalidInput("its log is behind a link, which is not followed");
    const std::string bytes = read_input_file("episode log", path, kMostLogBytes);
    return {log_of(fs::path(path).filename().string(), bytes), sha256_of(bytes)};
  }

  RowVerdict judge_episode(const ResultRow& row) {
    const auto [log, digest] = log_of_row(row);
    if (const std::string reason = first_difference(row, row_of(log, digest), "its log has"); !reason.empty())
      return {Judgement::kWrong, reason};
    if (const std::string ours = settings_without_seed(log); ours != settings_)
      return {Judgement::kWrong, "its log's settings are '" + ours + "'; those of the first log are '" +
                                     settings_.value_or("") + "'"};
    return logs_.judge(row, log);
  }

  const ResultsFolder& folder_;
  LogJudge logs_;
  std::optional<std::string> settings_;
};

class SubmissionVerification {
 public:
  SubmissionVerification(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
                         const Finding& finding)
      : folder_(folder), pool_(threads), judge_(folder, images, pool_.threads(), cpu), finding_(finding) {}

  Verdict all() {
    each_result(folder_.results(), [&](const ResultRow& row, std::size_t line) { take(row, line); });
    judge_taken();
    find_surplus_logs();
    return verdict_;
  }

 private:
  struct Taken {
    ResultRow row;
    std::string name;  // for people
    RowVerdict found;  // with a reason: it need not be judged
  };

  void wrong(const std::string& line) {
    ++verdict_.wrong;
    finding_(line);
  }

  void take(const ResultRow& row, std::size_t line) {
    const std::string& episode = field(row, "episode");
    const std::string name =
        "results.csv:" + std::to_string(line) + " (" + row[0] + ", episode " + episode + ")";
    taken_.push_back({row, name, {}});
    std::string& reason = taken_.back().found.reason;
    if (!is_plain(row[0]) || !is_plain(episode))
      reason = "unit and episode are accepted with letters, digits, '_', '.' and '-'";
    else if (!logs_.insert(folder_.log(row[0], episode)).second)
      reason = "it stands twice";
    else if (!judge_.has_settings())
      judge_.take_settings(row);
    if (taken_.size() == kRowsInMemory) judge_taken();
  }

  void judge_taken() {
    pool_.run(taken_.size(), [&](std::size_t i) {
      if (Taken& one = taken_[i]; one.found.reason.empty()) one.found = judge_.judge(one.row);
    });
    for (const Taken& one : taken_) count(one);
    taken_.clear();
  }

  void count(const Taken& one) {
    verdict_.frames += one.found.frames;
    switch (one.found.judgement) {
      case Judgement::kConfirmed: ++verdict_.confirmed; return;
      case Judgement::kWrong: return wrong(one.name + ": not confirmed: " + one.found.reason);
      case Judgement::kUnchecked:
        ++verdict_.unchecked;
        return finding_(one.name + ": could not be checked: " + one.found.reason);
    }
  }

  void find_surplus_logs() {
    std::set<std::string> surplus;
    std::error_code none;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.logs(), none))
      if (!entry.is_directory(none) && !logs_.contains(entry.path().string()))
        surplus.insert(entry.path().string());
    for (const std::string& path : surplus) wrong(path + ": no row of results.csv has this log");
  }

  const ResultsFolder& folder_;
  ThreadPool pool_;
  SubmissionJudge judge_;
  const Finding& finding_;
  std::vector<Taken> taken_;
  std::set<std::string> logs_;  // of the rows
  Verdict verdict_;
};

}  // namespace

bool is_submission(const ResultsFolder& folder) {
  return fs::exists(folder.root() + "/agent.toml") && !fs::exists(folder.plan());
}

Verdict verify_submission(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
                          const Finding& finding) {
  if (is_link(folder.logs()))
    throw InvalidInput(folder.logs() + ": this is a link, which is not followed; accepted is a folder");
  return SubmissionVerification(folder, images, threads, cpu, finding).all();
}

}  // namespace racebeam

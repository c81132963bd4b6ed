#include "agents/experiment/verify_submission.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "agents/experiment/agent_file.hpp"
#include "agents/experiment/phrase_seeds.hpp"
#include "agents/experiment/play.hpp"
#include "agents/experiment/row_tally.hpp"
#include "recording/sha256.hpp"
#include "recording/submission_folder.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

bool is_divergence(const ResultRow& row) { return field(row, "end") == "diverged"; }

class SubmissionJudge {
 public:
  SubmissionJudge(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu)
      : folder_(folder), logs_(images, threads, cpu) {}

  RowVerdict judge(const ResultRow& row) {
    if (is_divergence(row))
      return {Judgement::kUnchecked, "the trial diverged, so that it has no episode to play"};
    return judge_episode(row);
  }

  // All logs must have the settings of the first row's. Called before judge().
  void take_settings(const ResultRow& row) {
    try {
      const EpisodeLog log = log_of_row(row).first;
      settings_ = settings_without_seed(log.settings);
      preset_ = preset_of(words_of(settings_of(log), any_machine_));
    } catch (const std::exception&) {  // judge() says what is wrong
    }
  }
  bool has_settings() const { return settings_.has_value(); }
  std::string_view preset() const { return preset_; }  // of the first row's settings; empty: unknown

 private:
  std::pair<EpisodeLog, std::string> log_of_row(const ResultRow& row) const {
    const std::string path = folder_.log(row[0], field(row, "episode"));
    if (is_link(folder_.logs(row[0])) || is_link(path))
      throw InvalidInput("its log is behind a link, which is not followed");
    const std::string bytes = read_input_file("episode log", path, kMaxLogBytes);
    return {log_of(fs::path(path).filename().string(), bytes), sha256_of(bytes)};
  }

  RowVerdict judge_episode(const ResultRow& row) {
    const auto [log, digest] = log_of_row(row);
    if (const std::string reason = first_difference(row, row_of(log, digest), "its log has"); !reason.empty())
      return {Judgement::kWrong, reason};
    if (const std::string ours = settings_without_seed(log.settings); ours != settings_)
      return {Judgement::kWrong, "its log's settings are '" + ours + "'; those of the first log are '" +
                                     settings_.value_or("") + "'"};
    return logs_.judge(row, log);
  }

  const ResultsFolder& folder_;
  LogJudge logs_;
  const Environment any_machine_{load_image("builtin:beamfall"), find_game("beamfall"), Settings{}};
  std::optional<std::string> settings_;
  std::string_view preset_;
};

class SubmissionVerification {
 public:
  SubmissionVerification(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
                         const FindingCallback& finding)
      : folder_(folder),
        about_(read_agent_file(folder.root() + "/agent.toml")),
        tally_(threads, finding),
        judge_(folder, images, tally_.threads(), cpu) {
    if (about_.phrase) phrase_.emplace(*about_.phrase);
  }

  Verdict all() {
    each_result(folder_.results(), [&](const ResultRow& row, std::size_t line) { take(row, line); });
    if (!judge_.preset().empty() && judge_.preset() != about_.preset)
      tally_.add_wrong("agent.toml: preset is '" + about_.preset +
                       "'; the settings of the logs are those of '" + std::string(judge_.preset()) + "'");
    if (phrase_) phrase_->each_gap([&](const std::string& sentence) { tally_.add_wrong(sentence); });
    tally_.find_surplus(folder_.logs(), [&](const std::string& path, bool is_folder) {
      return is_folder ? !is_link(path) : logs_.contains(path);
    });
    return tally_.verdict();
  }

 private:
  void take(const ResultRow& row, std::size_t line) {
    const std::string name = name_of_row(row, line);
    if (const std::string fault = fault_of(row); !fault.empty())
      return tally_.add_wrong_row(name + ": not confirmed: " + fault);
    if (!judge_.has_settings()) judge_.take_settings(row);
    tally_.add_row(name, [this, row] { return judge_.judge(row); });
  }

  // What is wrong with a row without a look at its log; empty: nothing.
  std::string fault_of(const ResultRow& row) {
    const std::string& episode = field(row, "episode");
    for (const std::string_view column : {"unit", "episode"})
      if (!is_plain_name(field(row, column), kMaxUnitName))
        return std::string(column) + " is " + quote(field(row, column)) + "; it takes " +
               plain_name_rule(kMaxUnitName);
    const bool is_first = logs_.insert(folder_.log(row[0], episode)).second;
    if (field(row, "agent") != about_.agent)
      return "agent is '" + field(row, "agent") + "'; agent.toml has '" + about_.agent + "'";
    if (!is_first) return "it stands twice";
    return phrase_ && !is_divergence(row) ? phrase_->fault(row) : "";
  }

  const ResultsFolder& folder_;
  const AgentFile about_;
  RowTally tally_;
  SubmissionJudge judge_;
  std::optional<PhraseRows> phrase_;  // nothing: any seeds
  std::set<std::string> logs_;        // of the rows
};

}  // namespace

bool is_submission(const ResultsFolder& folder) {
  return fs::exists(folder.root() + "/agent.toml") && !fs::exists(folder.plan());
}

Verdict verify_submission(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
                          const FindingCallback& finding) {
  refuse_link(folder.logs());
  return SubmissionVerification(folder, images, threads, cpu, finding).all();
}

}  // namespace racebeam

#include "agents/experiment/verify.hpp"

#include <filesystem>
#include <set>

#include "agents/experiment/log_judge.hpp"
#include "agents/experiment/plan_rows.hpp"
#include "agents/experiment/row_tally.hpp"
#include "recording/sha256.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/words.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

// Returns a sentence about the first setting of a log that differs from the plan; empty if none does.
std::string first_difference_of_words(const std::string& ours, const std::string& theirs) {
  std::vector<std::string_view> own, expected;
  split(ours, own);
  split(theirs, expected);
  const auto sentence = [](std::string_view here, std::string_view there) {
    const auto text = [](std::string_view word) { return word.empty() ? "nothing" : quote(word); };
    return "its log's settings have " + text(here) + "; the plan gives " + text(there);
  };
  const auto same_key = [](const std::vector<std::string_view>& words, std::string_view word) {
    const auto found = std::ranges::find(words, key_value(word).key,
                                         [](std::string_view other) { return key_value(other).key; });
    return found == words.end() ? std::string_view() : *found;
  };
  for (const std::string_view word : own)
    if (const std::string_view there = same_key(expected, word); there != word) return sentence(word, there);
  for (const std::string_view word : expected)
    if (same_key(own, word).empty()) return sentence("", word);
  return "";
}

// Judges rows by the plan, and by their logs.
class RowJudge {
 public:
  RowJudge(const Plan& plan, const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu)
      : plan_(plan), folder_(folder), logs_(images, threads, cpu) {}

  RowVerdict judge(const ResultRow& row, const PlanRows::Place& place) {
    if (place.episode == 0) return judge_divergence(row, *place.unit);
    if (const std::string reason = against_plan(row, place); !reason.empty())
      return {Judgement::kWrong, reason};
    return judge_episode(row, place);
  }

 private:
  RowVerdict judge_divergence(const ResultRow& row, const Unit& unit) const {
    const std::string reason =
        first_difference(row, row_of_divergence(plan_, unit), "a trial of the plan that diverged has");
    if (!reason.empty()) return {Judgement::kWrong, reason};
    return {Judgement::kUnchecked, "the trial diverged, so that it has no episode to play"};
  }

  std::string against_plan(const ResultRow& row, const PlanRows::Place& place) const {
    ResultRow expected = row_of_plan(plan_, *place.unit, place.episode);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (expected[i].empty()) expected[i] = row[i];
    return first_difference(row, expected, "the plan gives");
  }

  RowVerdict judge_episode(const ResultRow& row, const PlanRows::Place& place) {
    if (!fs::exists(folder_.logs(row[0]))) return {Judgement::kUnchecked, "the unit's logs are not here"};
    const std::string path = folder_.log(row[0], field(row, "episode"));
    const std::string bytes = read_input_file("episode log", path, kMaxLogBytes);
    const EpisodeLog log = log_of(fs::path(path).filename().string(), bytes);
    if (const std::string reason = first_difference(row, row_of(log, sha256_of(bytes)), "its log has");
        !reason.empty())
      return {Judgement::kWrong, reason};
    if (const std::string reason = wrong_settings(log, place); !reason.empty())
      return {Judgement::kWrong, reason};
    return logs_.judge(row, log);
  }

  // Settings that the log leaves out have their defaults, as in a replay.
  std::string wrong_settings(const EpisodeLog& log, const PlanRows::Place& place) const {
    PlaySettings expected = play_settings(plan_, *place.unit->agent);
    expected.machine.random_seed = environment_seed(plan_, *place.unit, false, place.episode);
    const std::string ours = words_of(settings_of(log), any_machine_);
    const std::string theirs = words_of(expected, any_machine_);
    return first_difference_of_words(ours, theirs);
  }

  const Plan& plan_;
  const ResultsFolder& folder_;
  LogJudge logs_;
  const Environment any_machine_{load_image("builtin:beamfall"), find_game("beamfall"), Settings{}};
};

class Verification {
 public:
  Verification(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const FindingCallback& finding)
      : folder_(folder),
        plan_(plan_of_results(folder, images)),
        units_(units_of(plan_)),
        plan_rows_(units_),
        tally_(threads, finding),
        judge_(plan_, folder_, images, tally_.threads(), cpu) {}

  // The table is read twice, so that a table that does not fit is refused before a log is played.
  Verdict all() {
    each_result(folder_.results(), [&](const ResultRow& row, std::size_t) { plan_rows_.note(row); });
    each_result(folder_.results(), [&](const ResultRow& row, std::size_t line) { take(row, line); });
    find_missing();
    tally_.find_surplus(folder_.logs(), [&](const std::string& path, bool is_folder) {
      return is_folder ? is_expected_folder(path) : is_expected_log(path);
    });
    return tally_.verdict();
  }

 private:
  // Reports the rows of the plan that the table lacks. While the experiment is running, a unit without a row
  // is not finished.
  void find_missing() {
    const bool goes_on = fs::is_directory(folder_.work());
    plan_rows_.each_unmarked([&](const Unit& unit, int episode) {
      if (!goes_on || plan_rows_.has_marked(unit.name))
        tally_.add_wrong("results.csv: the row of " + unit.name + ", episode " + std::to_string(episode) +
                         " is missing");
      else
        tally_.add_unchecked(episode == 1 ? unit.name + ": is not finished" : "");
    });
  }

  // Passes a row to be judged, unless it is not in the plan, or occurs for the second time.
  void take(const ResultRow& row, std::size_t line) {
    const std::string name = name_of_row(row, line);
    const auto place = plan_rows_.find(row[0], field(row, "episode"));
    if (!place) {
      const std::string log = folder_.log(row[0], field(row, "episode"));
      std::error_code none;
      if (fs::exists(fs::symlink_status(log, none))) unplanned_logs_.insert(log);
      tally_.add_wrong_row(name + ": is not in the plan");
    } else if (!plan_rows_.mark(*place)) {
      tally_.add_wrong_row(name + ": stands twice");
    } else {
      tally_.add_row(name, [this, row, place] { return judge_.judge(row, *place); });
    }
  }

  // All folders are expected, but not links to folders. The exception is the link of a unit, whose logs may
  // lie elsewhere.
  bool is_expected_folder(const fs::path& path) const {
    return !is_link(path.string()) ||
           (path.parent_path() == folder_.logs() && plan_rows_.has(path.filename().string()));
  }

  bool is_expected_log(const fs::path& path) const {
    const std::string unit = path.parent_path().filename().string(), episode = path.stem().string();
    if (path == folder_.log(unit, episode))
      if (const auto place = plan_rows_.find(unit, episode); place && plan_rows_.is_marked(*place))
        return true;
    return unplanned_logs_.contains(path.string());
  }

  const ResultsFolder& folder_;
  const Plan plan_;
  const std::vector<Unit> units_;
  PlanRows plan_rows_;
  RowTally tally_;
  RowJudge judge_;
  std::set<std::string> unplanned_logs_;  // of rows that are not in the plan
};

}  // namespace

Plan plan_of_results(const ResultsFolder& folder, const Images& images) {
  const std::string text = read_input_file("plan", folder.plan(), kMaxPlanBytes);
  Plan plan = parse_plan(text, folder.plan(), images);
  if (plan.version.empty()) throw InvalidInput(folder.plan() + ": it lacks the key 'version'");
  for (const PlanGame& game : plan.games)
    if (game.image_md5.empty())
      throw InvalidInput(folder.plan() + ": images: the MD5 of the image of " + game.name + " is missing");
  return plan;
}

Verdict verify(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const FindingCallback& finding) {
  refuse_link(folder.logs());
  return Verification(folder, images, threads, cpu, finding).all();
}

}  // namespace racebeam

#include "agents/experiment/verify.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "agents/base/sealed_file.hpp"
#include "agents/experiment/play.hpp"
#include "environment/vector/thread_pool.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTableBytes = std::size_t{1} << 32;

enum class Judgement { kConfirmed, kWrong, kUnchecked };

struct RowVerdict {
  Judgement judgement = Judgement::kWrong;
  std::string reason;
  std::int64_t frames = 0;
};

std::string name_of_row(const ResultRow& row, std::size_t line) {
  return "results.csv:" + std::to_string(line) + " (" + row[0] + ", episode " + field(row, "episode") + ")";
}

// "score is 5; its log says 4", for the first column that differs; empty: none.
std::string first_difference(const ResultRow& row, const ResultRow& truth, const std::string& source) {
  for (std::size_t i = 0; i < row.size(); ++i)
    if (row[i] != truth[i])
      return std::string(kResultColumns[i]) + " is '" + row[i] + "'; " + source + " '" + truth[i] + "'";
  return "";
}

// Decisions, counted from 1, in which the state first differs.
std::string first_stretch(const EpisodeLog& log, const Replay& played) {
  const auto [ours, theirs] = std::ranges::mismatch(log.hashes, played.hashes);
  if (ours == log.hashes.end()) return "; every state is the same";
  const std::int64_t from = (ours - log.hashes.begin()) * kDecisionsPerStretch;
  return "; the first stretch that differs: decisions " + std::to_string(from + 1) + " to " +
         std::to_string(std::min(from + kDecisionsPerStretch, log.end.decisions));
}

class Verifier {
 public:
  Verifier(const ResultsFolder& folder, const Images& images, CpuKind cpu)
      : folder_(folder), images_(images), cpu_(cpu) {}

  RowVerdict judge(const ResultRow& row) const {
    try {
      return field(row, "end") == "diverged" ? judge_divergence(row) : judge_episode(row);
    } catch (const std::exception& error) {
      return {Judgement::kWrong, error.what()};
    }
  }

 private:
  static RowVerdict judge_divergence(const ResultRow& row) {
    for (const std::string_view column :
         {"environment_seed", "score", "frames", "decisions", "lives", "state_hash", "log_digest"})
      if (!field(row, column).empty())
        return {Judgement::kWrong,
                std::string(column) + " is '" + field(row, column) + "'; a trial that diverged has none"};
    return {Judgement::kUnchecked, "the trial diverged; there is no episode to play"};
  }

  RowVerdict judge_episode(const ResultRow& row) const {
    const std::string path = folder_.log(row[0], field(row, "episode"));
    const std::string bytes = read_input_file("episode log", path, kMostLogBytes);
    const EpisodeLog log = log_of(fs::path(path).filename().string(), bytes);
    if (const std::string reason = first_difference(row, row_of(log, sha256_of(bytes)), "its log has");
        !reason.empty())
      return {Judgement::kWrong, reason};
    const Cartridge* const cartridge = images_.find(log.image_md5);
    if (!cartridge) return {Judgement::kUnchecked, "no image with MD5 " + log.image_md5 + " is here"};
    return play_again(row, log, {cartridge->image, game_of(log, *cartridge)});
  }

  static std::shared_ptr<const Game> game_of(const EpisodeLog& log, const Cartridge& cartridge) {
    if (cartridge.game->name == log.game) return cartridge.game;
    auto game = find_game(log.game);
    if (!game) throw InvalidInput("its log is of the game '" + log.game + "', which is not in the catalogue");
    return game;
  }

  RowVerdict play_again(const ResultRow& row, const EpisodeLog& log, const Cartridge& cartridge) const {
    const Replay played = replay(log, cartridge, cpu_);
    EpisodeLog truth = log;
    truth.end = played.end;
    truth.hashes = played.hashes;
    std::string reason = first_difference(row, row_of(truth, field(row, "log_digest")), "the replay gives");
    if (reason.empty() && log.hashes == played.hashes) return {Judgement::kConfirmed, "", played.end.frames};
    if (reason.empty()) reason = "the end is the same, the way is not";
    return {Judgement::kWrong, reason + first_stretch(log, played), played.end.frames};
  }

  const ResultsFolder& folder_;
  const Images& images_;
  const CpuKind cpu_;
};

// The rows that the plan demands: unit and episode.
std::set<std::pair<std::string, std::string>> rows_of(const Plan& plan,
                                                      const std::set<std::string>& diverged) {
  std::set<std::pair<std::string, std::string>> rows;
  for (const Unit& unit : units_of(plan)) {
    if (diverged.contains(unit.name)) {
      rows.emplace(unit.name, "0");
      continue;
    }
    for (int episode = 1; episode <= unit.agent->length.evaluation_episodes; ++episode)
      rows.emplace(unit.name, std::to_string(episode));
  }
  return rows;
}

// What is missing, doubled or too many. Whether each row may be judged is returned: it is in the plan, and
// the first of its unit and episode.
std::vector<bool> compare_with_plan(const Plan& plan, const std::vector<ResultRow>& rows, Verdict& verdict,
                                    const Finding& finding) {
  std::set<std::string> diverged;
  for (const ResultRow& row : rows)
    if (field(row, "end") == "diverged") diverged.insert(row[0]);
  auto wanted = rows_of(plan, diverged);
  std::vector<bool> fit(rows.size());
  std::set<std::pair<std::string, std::string>> seen;
  const auto tell = [&](const std::string& line) {
    ++verdict.wrong;
    finding(line);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::pair<std::string, std::string> key(rows[i][0], field(rows[i], "episode"));
    fit[i] = wanted.contains(key) && seen.insert(key).second;
    if (!fit[i])
      tell(name_of_row(rows[i], i + 2) + (wanted.contains(key) ? ": stands twice" : ": is not in the plan"));
  }
  for (const auto& key : wanted)
    if (!seen.contains(key))
      tell("results.csv: the row of " + key.first + ", episode " + key.second + " is missing");
  return fit;
}

// The seeds of a row must be those that follow from the plan.
std::string wrong_seed(const ResultRow& row, const Plan& plan,
                       const std::map<std::string, const Unit*>& units) {
  const Unit& unit = *units.at(row[0]);
  const std::string agent = std::to_string(agent_seed(plan, unit));
  if (field(row, "agent_seed") != agent)
    return "agent_seed is '" + field(row, "agent_seed") + "'; the plan gives '" + agent + "'";
  if (field(row, "end") == "diverged") return "";
  const std::string seed =
      std::to_string(environment_seed(plan, unit, false, std::stoi(field(row, "episode"))));
  if (field(row, "environment_seed") != seed)
    return "environment_seed is '" + field(row, "environment_seed") + "'; the plan gives '" + seed + "'";
  return "";
}

void find_surplus_logs(const ResultsFolder& folder, const std::vector<ResultRow>& rows, Verdict& verdict,
                       const Finding& finding) {
  std::set<std::string> wanted;
  for (const ResultRow& row : rows) wanted.insert(folder.log(row[0], field(row, "episode")));
  std::set<std::string> surplus;
  std::error_code none;
  for (const auto& entry : fs::recursive_directory_iterator(folder.logs(), none))
    if (!entry.is_directory() && !wanted.contains(entry.path().string()))
      surplus.insert(entry.path().string());
  for (const std::string& path : surplus) {
    ++verdict.wrong;
    finding(path + ": no row of results.csv has this log");
  }
}

}  // namespace

Verdict verify(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const Finding& finding) {
  const Plan plan = parse_plan(read_input_file("plan", folder.plan(), kMostTableBytes), folder.plan());
  const auto rows =
      parse_results("results.csv", read_input_file("results", folder.results(), kMostTableBytes));
  std::map<std::string, const Unit*> units;
  const std::vector<Unit> all = units_of(plan);
  for (const Unit& unit : all) units.emplace(unit.name, &unit);

  Verdict verdict;
  const std::vector<bool> fit = compare_with_plan(plan, rows, verdict, finding);
  std::vector<RowVerdict> verdicts(rows.size());
  const Verifier verifier(folder, images, cpu);
  ThreadPool(threads).run(rows.size(), [&](std::size_t i) {
    if (fit[i]) verdicts[i] = verifier.judge(rows[i]);
  });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!fit[i]) continue;
    RowVerdict& found = verdicts[i];
    verdict.frames += found.frames;
    if (const std::string reason = wrong_seed(rows[i], plan, units);
        !reason.empty() && found.judgement != Judgement::kWrong)
      found = {Judgement::kWrong, reason};
    if (found.judgement == Judgement::kConfirmed) {
      ++verdict.confirmed;
      continue;
    }
    ++(found.judgement == Judgement::kWrong ? verdict.wrong : verdict.unchecked);
    finding(name_of_row(rows[i], i + 2) +
            (found.judgement == Judgement::kWrong ? ": not confirmed: " : ": could not be checked: ") +
            found.reason);
  }
  find_surplus_logs(folder, rows, verdict, finding);
  return verdict;
}

}  // namespace racebeam

#include "agents/experiment/verify.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "agents/base/sealed_file.hpp"
#include "agents/experiment/plan_rows.hpp"
#include "agents/experiment/play.hpp"
#include "environment/vector/thread_pool.hpp"
#include "protocol/line/words.hpp"
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

// The first setting of a log that is not the plan's.
std::string first_difference_of_words(const std::string& ours, const std::string& theirs) {
  std::vector<std::string_view> own, wanted;
  split(ours, own);
  split(theirs, wanted);
  const auto tell = [](std::string_view here, std::string_view there) {
    const auto text = [](std::string_view word) { return word.empty() ? "nothing" : quote(word); };
    return "its log's settings have " + text(here) + "; the plan gives " + text(there);
  };
  const auto same_key = [](const std::vector<std::string_view>& words, std::string_view word) {
    const auto found = std::ranges::find(words, key_value(word).key,
                                         [](std::string_view other) { return key_value(other).key; });
    return found == words.end() ? std::string_view() : *found;
  };
  for (const std::string_view word : own)
    if (const std::string_view there = same_key(wanted, word); there != word) return tell(word, there);
  for (const std::string_view word : wanted)
    if (same_key(own, word).empty()) return tell("", word);
  return "";
}

class Verifier {
 public:
  Verifier(const Plan& plan, const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu)
      : plan_(plan), folder_(folder), images_(images), replayer_(threads, cpu) {}

  RowVerdict judge(const ResultRow& row, const PlanRows::Place& place) {
    try {
      if (place.episode == 0) return judge_divergence(row, *place.unit);
      if (const std::string reason = against_plan(row, place); !reason.empty())
        return {Judgement::kWrong, reason};
      return judge_episode(row, place);
    } catch (const std::exception& error) {
      return {Judgement::kWrong, error.what()};
    }
  }

 private:
  RowVerdict judge_divergence(const ResultRow& row, const Unit& unit) const {
    const std::string reason =
        first_difference(row, row_of_divergence(plan_, unit), "a trial of the plan that diverged has");
    if (!reason.empty()) return {Judgement::kWrong, reason};
    return {Judgement::kUnchecked, "the trial diverged; there is no episode to play"};
  }

  std::string against_plan(const ResultRow& row, const PlanRows::Place& place) const {
    ResultRow wanted = row_of_plan(plan_, *place.unit, place.episode);
    for (std::size_t i = 0; i < row.size(); ++i)
      if (wanted[i].empty()) wanted[i] = row[i];
    return first_difference(row, wanted, "the plan gives");
  }

  RowVerdict judge_episode(const ResultRow& row, const PlanRows::Place& place) {
    const std::string path = folder_.log(row[0], field(row, "episode"));
    const std::string bytes = read_input_file("episode log", path, kMostLogBytes);
    const EpisodeLog log = log_of(fs::path(path).filename().string(), bytes);
    if (const std::string reason = first_difference(row, row_of(log, sha256_of(bytes)), "its log has");
        !reason.empty())
      return {Judgement::kWrong, reason};
    if (const std::string reason = wrong_settings(log, place); !reason.empty())
      return {Judgement::kWrong, reason};
    const Cartridge* const cartridge = images_.find(log.image_md5);
    if (!cartridge) return {Judgement::kUnchecked, "no image with MD5 " + log.image_md5 + " is here"};
    return play_again(row, log, {cartridge->image, game_of(log, *cartridge)});
  }

  // Settings that the log leaves out have their defaults, as in a replay.
  std::string wrong_settings(const EpisodeLog& log, const PlanRows::Place& place) const {
    PlaySettings wanted = play_settings(plan_, *place.unit->agent);
    wanted.machine.random_seed = environment_seed(plan_, *place.unit, false, place.episode);
    const std::string ours = words_of(settings_of(log), any_machine_);
    const std::string theirs = words_of(wanted, any_machine_);
    return first_difference_of_words(ours, theirs);
  }

  static std::shared_ptr<const Game> game_of(const EpisodeLog& log, const Cartridge& cartridge) {
    if (cartridge.game->name == log.game) return cartridge.game;
    auto game = find_game(log.game);
    if (!game) throw InvalidInput("its log is of the game '" + log.game + "', which is not in the catalogue");
    return game;
  }

  RowVerdict play_again(const ResultRow& row, const EpisodeLog& log, const Cartridge& cartridge) {
    const Replay played = replayer_.play(log, cartridge);
    EpisodeLog truth = log;
    truth.end = played.end;
    truth.hashes = played.hashes;
    std::string reason = first_difference(row, row_of(truth, field(row, "log_digest")), "the replay gives");
    if (reason.empty() && log.hashes != played.hashes) reason = "the end is the same, the way is not";
    if (!reason.empty()) return {Judgement::kWrong, reason + first_stretch(log, played), played.end.frames};
    if (!played.over)
      return {Judgement::kWrong, "the episode is not over after its last action; the log was cut short",
              played.end.frames};
    return {Judgement::kConfirmed, "", played.end.frames};
  }

  const Plan& plan_;
  const ResultsFolder& folder_;
  const Images& images_;
  Replayer replayer_;
  const Environment any_machine_{load_image("builtin:beamfall"), find_game("beamfall"), Settings{}};
};

// What is missing, doubled or too many. The place in the plan of each row that may be judged is returned.
std::vector<std::optional<PlanRows::Place>> compare_with_plan(PlanRows& wanted,
                                                              const std::vector<ResultRow>& rows,
                                                              Verdict& verdict, const Finding& finding) {
  const auto tell = [&](const std::string& line) {
    ++verdict.wrong;
    finding(line);
  };
  std::vector<std::optional<PlanRows::Place>> places(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto place = wanted.find(rows[i]);
    if (!place)
      tell(name_of_row(rows[i], i + 2) + ": is not in the plan");
    else if (!wanted.mark(*place))
      tell(name_of_row(rows[i], i + 2) + ": stands twice");
    else
      places[i] = place;
  }
  wanted.each_unmarked([&](const Unit& unit, int episode) {
    tell("results.csv: the row of " + unit.name + ", episode " + std::to_string(episode) + " is missing");
  });
  return places;
}

// The plan of results, which has the images and the version.
Plan plan_of(const ResultsFolder& folder) {
  const std::string text = read_input_file("plan", folder.plan(), kMostPlanBytes);
  Plan plan = parse_plan(text, folder.plan());
  if (plan.version.empty()) throw InvalidInput(folder.plan() + ": it lacks the key 'version'");
  for (const PlanGame& game : plan.games)
    if (game.image_md5.empty())
      throw InvalidInput(folder.plan() + ": images: the MD5 of the image of " + game.name + " is missing");
  return plan;
}

void find_surplus_logs(const ResultsFolder& folder, const std::vector<ResultRow>& rows, Verdict& verdict,
                       const Finding& finding) {
  std::set<std::string> wanted;
  for (const ResultRow& row : rows) wanted.insert(folder.log(row[0], field(row, "episode")));
  std::set<std::string> surplus;
  std::error_code none;
  const auto holds_logs = [&](const fs::directory_entry& entry) {
    const std::string inside = entry.path().string() + '/';
    const auto first = wanted.lower_bound(inside);
    return first != wanted.end() && first->starts_with(inside);
  };
  for (const auto& entry : fs::recursive_directory_iterator(folder.logs(), none)) {
    const bool is_folder = entry.is_directory() && !(entry.is_symlink() && !holds_logs(entry));
    if (!is_folder && !wanted.contains(entry.path().string())) surplus.insert(entry.path().string());
  }
  for (const std::string& path : surplus) {
    ++verdict.wrong;
    finding(path + ": no row of results.csv has this log");
  }
}

}  // namespace

Verdict verify(const ResultsFolder& folder, const Images& images, unsigned threads, CpuKind cpu,
               const Finding& finding) {
  const Plan plan = plan_of(folder);
  const auto rows =
      parse_results("results.csv", read_input_file("results", folder.results(), kMostTableBytes));
  const std::vector<Unit> units = units_of(plan);
  PlanRows wanted(units, rows);

  Verdict verdict;
  const auto places = compare_with_plan(wanted, rows, verdict, finding);
  std::vector<RowVerdict> verdicts(rows.size());
  ThreadPool pool(threads);
  Verifier verifier(plan, folder, images, pool.threads(), cpu);
  pool.run(rows.size(), [&](std::size_t i) {
    if (places[i]) verdicts[i] = verifier.judge(rows[i], *places[i]);
  });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!places[i]) continue;
    const RowVerdict& found = verdicts[i];
    verdict.frames += found.frames;
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

#include "agents/experiment/rerun.hpp"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <numeric>
#include <system_error>

#include "agents/base/random.hpp"
#include "agents/experiment/cost.hpp"
#include "agents/experiment/log_judge.hpp"
#include "agents/experiment/trial.hpp"
#include "agents/features/game_facts.hpp"
#include "environment/vector/thread_pool.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"
#include "system/output_file.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxCurveBytes = 1 << 16;  // of a line
constexpr std::chrono::hours kNoCheckpoints{24 * 365};

// A folder of results that is removed at the end.
class TemporaryResults {
 public:
  TemporaryResults() : path_((fs::temp_directory_path() / "racebeam-rerun-XXXXXX").string()) {
    if (!make_temporary_folder(path_))
      throw std::system_error(errno, std::generic_category(), "cannot make the folder " + path_);
    for (const std::string& path : {folder().units(), folder().facts(), folder().work()})
      fs::create_directory(path);
  }
  ~TemporaryResults() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  TemporaryResults(const TemporaryResults&) = delete;
  TemporaryResults& operator=(const TemporaryResults&) = delete;

  ResultsFolder folder() const { return ResultsFolder(path_); }

 private:
  std::string path_;
};

// The lines of a table whose first field is a chosen unit, by this.
using Lines = std::map<std::string, std::vector<std::string>, std::less<>>;

void take_lines(const std::string& path, Lines& lines) {
  if (!fs::exists(path)) return;
  each_line("table", path, kMaxCurveBytes, [&](std::string_view line, bool) {
    const auto found = lines.find(line.substr(0, line.find(',')));
    if (found != lines.end()) found->second.emplace_back(line);
  });
}

std::vector<std::string> lines_of_file(const std::string& path) {
  std::vector<std::string> lines;
  each_line("table", path, kMaxCurveBytes, [&](std::string_view line, bool) { lines.emplace_back(line); });
  return lines;
}

std::string column_of(std::string_view line, std::size_t column) {
  for (; column > 0; --column) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
  return std::string(line.substr(0, line.find(',')));
}

// A table whose rows must be the same, by its columns.
struct Table {
  std::string_view name;
  std::span<const std::string_view> columns;

  std::size_t place(std::string_view column) const {
    return static_cast<std::size_t>(std::ranges::find(columns, column) - columns.begin());
  }

  // The first row that differs, by the score if that does; empty: none.
  std::string difference(const std::vector<std::string>& there, const std::vector<std::string>& now) const {
    if (there.size() != now.size())
      return std::string(name) + " has " + std::to_string(there.size()) + " rows; played again it has " +
             std::to_string(now.size());
    const auto [theirs, ours] = std::ranges::mismatch(there, now);
    return theirs == there.end() ? "" : difference(*theirs, *ours);
  }

 private:
  std::string difference(const std::string& theirs, const std::string& ours) const {
    std::size_t column = place("score");
    if (column_of(theirs, column) == column_of(ours, column))
      for (column = 0; column + 1 < columns.size() && column_of(theirs, column) == column_of(ours, column);)
        ++column;
    return std::string(name) + ", episode " + column_of(ours, place("episode")) + ": " +
           std::string(columns[column]) + " is " + column_of(theirs, column) +
           "; played again, the agent has " + column_of(ours, column);
  }
};
constexpr Table kResults{"results.csv", kResultColumns}, kCurves{"curves.csv", kCurveColumns};

class Rerun {
 public:
  Rerun(const ResultsFolder& folder, const Images& images, const RerunSettings& settings,
        const FindingCallback& finding)
      : folder_(folder), images_(images), settings_(settings), finding_(finding) {
    if (!fs::exists(folder.plan()))
      throw InvalidInput(folder.root() +
                         " has no plan.toml, so that nothing says how its agent is made; --rerun accepts the "
                         "folder of an experiment");
    plan_ = plan_of_results(folder, images);
    bind(plan_, images, settings.version);
    check_memory(plan_, settings.threads, usable_memory());
  }

  RerunVerdict all() {
    choose();
    for (const PlanGame& game : plan_.games)
      if (!game.background_csv.empty()) take_background(game.name);
    take_lines(folder_.results(), results_);
    take_lines(folder_.curves(), curves_);
    ThreadPool pool(settings_.threads);
    pool.run(chosen_.size(), [this](std::size_t i) { attempt(chosen_[i]); });
    if (failure_) std::rethrow_exception(failure_);
    return verdict_;
  }

 private:
  void choose() {
    std::vector<Unit> units = units_of(plan_);
    const std::size_t count = std::min(static_cast<std::size_t>(settings_.units), units.size());
    Random random(settings_.seed);
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(units[i], units[i + random.below(units.size() - i)]);
      results_[units[i].name];
      curves_[units[i].name];
      chosen_.push_back(units[i]);
    }
  }

  void take_background(const std::string& game) {
    const std::string file = '/' + game + ".background";
    fs::copy_file(folder_.facts() + file, scratch_.folder().facts() + file);
  }

  void attempt(const Unit& unit) {
    try {
      if (is_failed()) return;
      const std::string difference = play(unit);
      const std::lock_guard lock(mutex_);
      ++(difference.empty() ? verdict_.same : verdict_.different);
      finding_(unit.name + (difference.empty() ? ": played again, and all rows are the same"
                                               : ": not the same: " + difference));
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
  }

  bool is_failed() {
    const std::lock_guard lock(mutex_);
    return failure_ != nullptr;
  }

  // Returns the first difference.
  std::string play(const Unit& unit) {
    const ResultsFolder scratch = scratch_.folder();
    const Cartridge& cartridge = *images_.find(unit.game->name);
    GameFacts facts(cartridge, sample_settings(plan_, *unit.game), scratch.facts());
    Trial(plan_, unit, scratch, cartridge, &facts, settings_.cpu)
        .run(
            kNoCheckpoints, [] { return false; }, settings_.check);
    const auto difference = [&](const Table& table, const Lines& there, std::string_view kind) {
      return table.difference(there.at(unit.name), lines_of_file(scratch.unit(unit.name, kind)));
    };
    const std::string first = difference(kResults, results_, "results");
    return first.empty() && fs::exists(folder_.curves()) ? difference(kCurves, curves_, "curves") : first;
  }

  const ResultsFolder& folder_;
  const Images& images_;
  const RerunSettings& settings_;
  const FindingCallback& finding_;
  const TemporaryResults scratch_;
  Plan plan_;
  std::vector<Unit> chosen_;
  Lines results_, curves_;  // of the chosen units
  std::mutex mutex_;
  std::exception_ptr failure_;
  RerunVerdict verdict_;
};

}  // namespace

RerunVerdict rerun(const ResultsFolder& folder, const Images& images, const RerunSettings& settings,
                   const FindingCallback& finding) {
  return Rerun(folder, images, settings, finding).all();
}

}  // namespace racebeam

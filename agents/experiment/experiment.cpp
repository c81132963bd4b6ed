#include "agents/experiment/experiment.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

#include "agents/experiment/cost.hpp"
#include "agents/experiment/trial.hpp"
#include "agents/features/game_facts.hpp"
#include "recording/atomic_file.hpp"
#include "system/file_lock.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxTableBytes = std::size_t{1} << 32;
constexpr std::chrono::seconds kBetweenCounts{10};  // a look at each unit may take long on a network's disk

std::string first_difference(std::string_view ours, std::string_view theirs) {
  while (!ours.empty() || !theirs.empty()) {
    const std::string_view a = ours.substr(0, ours.find('\n')), b = theirs.substr(0, theirs.find('\n'));
    if (a != b) return "here '" + std::string(a) + "', there '" + std::string(b) + "'";
    ours.remove_prefix(std::min(a.size() + 1, ours.size()));
    theirs.remove_prefix(std::min(b.size() + 1, theirs.size()));
  }
  return "no line";
}

void check_plan(const ResultsFolder& folder, const std::string& text) {
  const std::string there = read_input_file("plan", folder.plan(), kMaxPlanBytes);
  if (there != text)
    throw InvalidInput(folder.root() + " holds results of another plan; the first difference is: " +
                       first_difference(text, there) + "; choose another folder");
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error("cannot make the folder " + path + ": " + error.message());
}

// A lock in the folder `work`, which every process removes that finds all units finished.
auto with_lock(const ResultsFolder& folder, const std::string& name, const auto& lock) {
  constexpr int kMaxAttempts = 10'000;
  for (int attempt = 1;; ++attempt) {
    make_folder(folder.work());
    try {
      return lock(folder.lock(name));
    } catch (const std::system_error& error) {
      if (error.code() != std::errc::no_such_file_or_directory || attempt == kMaxAttempts) throw;
    }
  }
}

FileLock lock_plan(const ResultsFolder& folder) {
  return with_lock(folder, "plan", [](const std::string& path) { return FileLock(path); });
}

// Whether a process of an experiment has made this file in the folder `work`.
bool is_own(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".lock") || name.ends_with(".checkpoint") || name.ends_with(".checkpoint.part");
}

// Finds a file of the user that has the name of one that an experiment writes; else returns an empty path.
// The files of games may exist before: the experiment checks and reads them.
fs::path foreign_file(const ResultsFolder& folder) {
  std::error_code none;
  for (const std::string& path :
       {folder.results(), folder.curves(), folder.times(), folder.agents(), folder.units(), folder.logs()})
    if (fs::exists(fs::symlink_status(path, none))) return path;
  if (fs::is_symlink(folder.work(), none)) return folder.work();
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.work(), none))
    if (!is_own(entry.path())) return entry.path();
  return {};
}

// Checks for the plan last, since another process of this experiment writes it before the other files.
void refuse_foreign_files(const ResultsFolder& folder) {
  const fs::path foreign = foreign_file(folder);
  if (foreign.empty() || fs::exists(folder.plan())) return;
  throw InvalidInput(folder.root() + " has no plan.toml, but " + foreign.string() +
                     ", which an experiment would replace; choose another folder");
}

std::ptrdiff_t lines_of(const std::string& path) {
  std::error_code none;
  if (!fs::exists(path, none)) return 0;
  std::ptrdiff_t lines = 0;
  each_piece("table", path, [&](std::string_view piece) { lines += std::ranges::count(piece, '\n'); });
  return lines;
}

// The tables are put together from `units`. A folder whose table has rows that no unit has would lose them.
void refuse_lost_units(const ResultsFolder& folder, const Plan& plan) {
  std::ptrdiff_t found = 0;
  for (const Unit& unit : units_of(plan)) found += lines_of(folder.unit(unit.name, "results"));
  const std::ptrdiff_t rows = lines_of(folder.results()) - 1;
  if (rows > found)
    throw InvalidInput(folder.results() + " has " + std::to_string(rows) + " rows, and " + folder.units() +
                       " has " + std::to_string(found) + " of them, so that the others would be lost; " +
                       "choose another folder");
}

// Claims the folder for this plan, or checks that it has been. Writes nothing if it cannot be used.
void claim(const ResultsFolder& folder, const Plan& plan, const Images& images) {
  const std::string text = text_of(plan);
  std::error_code none;
  if (fs::exists(folder.plan(), none)) check_plan(folder, text);
  for (const PlanGame& game : plan.games)
    GameFacts(*images.find(game.name), sample_settings(plan, game), folder.facts()).check();
  refuse_foreign_files(folder);
  make_folder(folder.root());
  const FileLock lock = lock_plan(folder);
  fs::exists(folder.plan()) ? check_plan(folder, text) : replace_file(folder.plan(), text, Durable::kNow);
  refuse_lost_units(folder, plan);
  for (const std::string& path : {folder.units(), folder.logs(), folder.facts()}) make_folder(path);
}

bool is_finished(const ResultsFolder& folder, const Unit& unit) {
  return fs::exists(folder.unit(unit.name, "results"));
}

void remove_work(const ResultsFolder& folder) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.work(), none))
    if (is_own(entry.path())) fs::remove(entry.path(), none);
  fs::remove(folder.work(), none);
}

std::string table_of_agents(const std::vector<Unit>& units) {
  std::string table = line_of(kAgentColumns);
  std::set<std::string_view> names;
  for (const Unit& unit : units)
    if (names.insert(unit.agent_name).second)
      ((table += unit.agent_name + ',') += name_of(unit.agent->kind->role)) += '\n';
  return table;
}

// Merges the tables of the finished units, in the plan's order. Under the lock, so that the process which
// finishes last writes last.
void merge_tables(const ResultsFolder& folder, const std::vector<Unit>& units) {
  const FileLock lock = lock_plan(folder);
  std::string results = line_of(kResultColumns), curves = line_of(kCurveColumns),
              times = line_of(kTimeColumns);
  std::size_t finished = 0;
  for (const Unit& unit : units) {
    if (!is_finished(folder, unit)) continue;
    ++finished;
    results += read_input_file("table", folder.unit(unit.name, "results"), kMaxTableBytes);
    curves += read_input_file("table", folder.unit(unit.name, "curves"), kMaxTableBytes);
    times += read_input_file("table", folder.unit(unit.name, "times"), kMaxTableBytes);
  }
  replace_file(folder.agents(), table_of_agents(units), Durable::kLater);
  replace_file(folder.times(), times, Durable::kLater);
  replace_file(folder.curves(), curves, Durable::kLater);
  replace_file(folder.results(), results, Durable::kNow);
  if (finished == units.size()) remove_work(folder);
}

class Run {
 public:
  Run(const Plan& plan, const Images& images, const ResultsFolder& folder, const ExperimentSettings& settings,
      const ProgressCallback& report)
      : plan_(plan), images_(images), folder_(folder), settings_(settings), report_(report) {}

  void all() {
    claim(folder_, plan_, images_);
    const std::vector<Unit> units = units_of(plan_);
    for (std::size_t i = settings_.shard - 1; i < units.size(); i += settings_.shards)
      if (!is_finished(folder_, units[i]))
        mine_.push_back({.unit = &units[i],
                         .seconds = seconds_of_trial(
                             *units[i].agent, PlayRates().of(plan_, *units[i].game, *units[i].agent))});
    run_on_all_threads();
    if (!failure_) run_on_all_threads();  // what another process ran may be finished, or free, by now
    finish(units);
  }

 private:
  // A unit that this process may run.
  struct Own {
    const Unit* unit;
    double seconds;           // how long it is expected to take
    double before = 0;        // the share that was done before this process began it
    double done = 0;          // the share that is done by now
    bool is_running = false;  // in this process
    bool is_over = false;     // finished, by any process
  };

  void run_on_all_threads() {
    next_ = 0;
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < settings_.threads; ++i) threads.emplace_back([this] { work(); });
    work();
  }

  // Merges the tables of finished units, even if a unit failed.
  void finish(const std::vector<Unit>& units) {
    try {
      merge_tables(folder_, units);
    } catch (...) {
      if (!failure_) throw;  // else the first failure says more
    }
    if (failure_) std::rethrow_exception(failure_);
    const auto busy =
        std::ranges::find_if(mine_, [this](const Own& own) { return !is_finished(folder_, *own.unit); });
    if (busy != mine_.end())
      throw std::runtime_error(busy->unit->name +
                               " is being run by another process; repeat the command when it has ended");
  }

  void work() {
    try {
      while (!stop_) {
        const std::size_t next = next_++;
        if (next >= mine_.size()) return;
        if (!mine_[next].is_over) run(mine_[next]);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
  }

  void run(Own& own) {
    const Unit& unit = *own.unit;
    if (is_finished(folder_, unit)) return note_finished(own);
    const auto lock = with_lock(folder_, unit.name, FileLock::attempt);
    if (!lock) return;
    if (is_finished(folder_, unit)) return note_finished(own);
    const Cartridge& cartridge = *images_.find(unit.game->name);
    GameFacts facts(cartridge, sample_settings(plan_, *unit.game), folder_.facts());
    Trial trial(plan_, unit, folder_, cartridge, &facts, settings_.cpu);
    begin(own, trial);
    if (trial.run(
            settings_.checkpoints, [this] { return stop_.load(); }, on_decision(own, trial)))
      report_end(own, trial);
  }

  // Called for a unit that another process has finished.
  void note_finished(Own& own) {
    const std::lock_guard lock(mutex_);
    count_other(own);
  }

  // Requires the mutex.
  void count_other(Own& own) {
    if (own.is_over) return;
    ++finished_;
    own.is_over = true;
    own.before = own.done = 1;
  }

  // Counts the units that other processes have finished. Requires the mutex.
  void count_others() {
    last_count_ = Clock::now();
    for (Own& own : mine_)
      if (!own.is_over && !own.is_running && is_finished(folder_, *own.unit)) count_other(own);
  }

  void begin(Own& own, const Trial& trial) {
    const std::lock_guard lock(mutex_);
    own.is_running = true;
    own.before = own.done = trial.place().done;
  }

  std::function<void()> on_decision(Own& own, const Trial& trial) {
    if (settings_.reports.count() == 0) return settings_.check;
    return [this, &own, &trial, last = Clock::now()]() mutable {
      if (settings_.check) settings_.check();
      if (Clock::now() - last < settings_.reports) return;
      last = Clock::now();
      const Trial::Place place = trial.place();
      const std::lock_guard lock(mutex_);
      own.done = place.done;
      if (last - last_count_ >= kBetweenCounts) count_others();
      Progress at = progress(own);
      at.episodes = place.episodes;
      at.decisions = place.decisions;
      report_(at);
    };
  }

  void report_end(Own& own, const Trial& trial) {
    const std::lock_guard lock(mutex_);
    ++finished_;
    own.is_over = true;
    own.done = 1;
    count_others();
    Progress at = progress(own);
    at.unit_finished = true;
    at.episodes = own.unit->agent->length.evaluation_episodes;
    at.mean_score = trial.mean_score();
    report_(at);
  }

  Progress progress(const Own& own) const {
    double done = 0, left = 0;
    for (const Own& each : mine_) {
      done += each.seconds * (each.done - each.before);
      left += each.seconds * (1 - each.done);
    }
    Progress at{.finished = finished_, .all = mine_.size(), .unit = own.unit->name};
    at.elapsed = Clock::now() - start_;
    if (done > 0) at.left = at.elapsed * (left / done);
    return at;
  }

  const Plan& plan_;
  const Images& images_;
  const ResultsFolder& folder_;
  const ExperimentSettings& settings_;
  const ProgressCallback& report_;
  const Clock::time_point start_ = Clock::now();
  std::vector<Own> mine_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::size_t finished_ = 0;
  Clock::time_point last_count_ = start_;  // of the units of other processes
  std::exception_ptr failure_;
};

}  // namespace

void run_experiment(const Plan& plan, const Images& images, const ResultsFolder& folder,
                    const ExperimentSettings& settings, const ProgressCallback& report) {
  Run(plan, images, folder, settings, report).all();
}

}  // namespace racebeam

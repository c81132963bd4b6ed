#include "agents/experiment/experiment.hpp"

#include <atomic>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "agents/base/file_lock.hpp"
#include "agents/experiment/trial.hpp"
#include "agents/features/game_facts.hpp"
#include "recording/atomic_file.hpp"
#include "system/input_file.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostTableBytes = std::size_t{1} << 32;

std::string first_difference(std::string_view ours, std::string_view theirs) {
  while (!ours.empty() || !theirs.empty()) {
    const std::string_view a = ours.substr(0, ours.find('\n')), b = theirs.substr(0, theirs.find('\n'));
    if (a != b) return "here '" + std::string(a) + "', there '" + std::string(b) + "'";
    ours.remove_prefix(std::min(a.size() + 1, ours.size()));
    theirs.remove_prefix(std::min(b.size() + 1, theirs.size()));
  }
  return "no line";
}

// Claims the folder for this plan, or checks that it has been.
void claim(const ResultsFolder& folder, const Plan& plan) {
  for (const std::string& path :
       {folder.root(), folder.units(), folder.logs(), folder.facts(), folder.work()})
    fs::create_directories(path);
  const FileLock lock(folder.lock("plan"));
  const std::string text = text_of(plan);
  if (!fs::exists(folder.plan())) return replace_file(folder.plan(), text, Durable::kNow);
  const std::string there = read_input_file("plan", folder.plan(), kMostTableBytes);
  if (there != text)
    throw InvalidInput(folder.root() + " holds results of another plan; the first difference is: " +
                       first_difference(text, there) + "; choose another folder");
}

bool is_finished(const ResultsFolder& folder, const Unit& unit) {
  return fs::exists(folder.unit(unit.name, "results"));
}

// Puts the finished units together, in the plan's order. Under the lock, so that the process which finishes
// last writes last.
void put_together(const ResultsFolder& folder, const std::vector<Unit>& units) {
  const FileLock lock(folder.lock("plan"));
  std::string results = line_of(kResultColumns), curves = line_of(kCurveColumns),
              times = line_of(kTimeColumns);
  std::size_t finished = 0;
  for (const Unit& unit : units) {
    if (!is_finished(folder, unit)) continue;
    ++finished;
    results += read_input_file("table", folder.unit(unit.name, "results"), kMostTableBytes);
    curves += read_input_file("table", folder.unit(unit.name, "curves"), kMostTableBytes);
    times += read_input_file("table", folder.unit(unit.name, "times"), kMostTableBytes);
  }
  replace_file(folder.times(), times, Durable::kLater);
  replace_file(folder.curves(), curves, Durable::kLater);
  replace_file(folder.results(), results, Durable::kNow);
  if (finished == units.size()) fs::remove_all(folder.work());
}

class Run {
 public:
  Run(const Plan& plan, const Images& images, const ResultsFolder& folder, const ExperimentSettings& settings,
      const Report& report)
      : plan_(plan), images_(images), folder_(folder), settings_(settings), report_(report) {}

  void all() {
    claim(folder_, plan_);
    const std::vector<Unit> units = units_of(plan_);
    for (std::size_t i = settings_.shard - 1; i < units.size(); i += settings_.shards)
      if (!is_finished(folder_, units[i])) mine_.push_back(&units[i]);
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < settings_.threads; ++i) threads.emplace_back([this] { work(); });
    work();
    threads.clear();
    if (failure_) std::rethrow_exception(failure_);
    put_together(folder_, units);
    if (!busy_.empty())
      throw std::runtime_error(busy_ +
                               " is being run by another process; repeat the command when it has ended");
  }

 private:
  void work() {
    try {
      while (!stop_) {
        const std::size_t next = next_++;
        if (next >= mine_.size()) return;
        run(*mine_[next]);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      stop_ = true;
    }
  }

  void run(const Unit& unit) {
    const auto lock = FileLock::attempt(folder_.lock(unit.name));
    if (!lock) {
      const std::lock_guard guard(mutex_);
      if (busy_.empty()) busy_ = unit.name;
      return;
    }
    if (is_finished(folder_, unit)) return;  // by another process, meanwhile
    const Cartridge& cartridge = *images_.find(unit.game->name);
    GameFacts facts(cartridge, {plan_.seed, plan_.background_screens, plan_.class_screens, plan_.play},
                    folder_.facts());
    Trial trial(plan_, unit, folder_, cartridge, &facts, settings_.cpu);
    if (trial.run(settings_.checkpoints, [this] { return stop_.load(); })) tell(unit, trial);
  }

  void tell(const Unit& unit, const Trial& trial) {
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> elapsed = Clock::now() - start_;
    ++finished_;
    const double left = static_cast<double>(mine_.size() - finished_) / static_cast<double>(finished_);
    report_({finished_, mine_.size(), unit.name, unit.agent->length.evaluation_episodes, trial.mean_score(),
             elapsed, left * elapsed});
  }

  const Plan& plan_;
  const Images& images_;
  const ResultsFolder& folder_;
  const ExperimentSettings& settings_;
  const Report& report_;
  const Clock::time_point start_ = Clock::now();
  std::vector<const Unit*> mine_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::size_t finished_ = 0;
  std::string busy_;
  std::exception_ptr failure_;
};

}  // namespace

void run_experiment(const Plan& plan, const Images& images, const ResultsFolder& folder,
                    const ExperimentSettings& settings, const Report& report) {
  Run(plan, images, folder, settings, report).all();
}

}  // namespace racebeam

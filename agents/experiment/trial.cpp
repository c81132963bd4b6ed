#include "agents/experiment/trial.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>

#include "agents/experiment/cost.hpp"
#include "recording/atomic_file.hpp"
#include "recording/sha256.hpp"
#include "system/clock.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

using Clock = std::chrono::steady_clock;

AgentContext context_of(const Plan& plan, const Unit& unit, const AgentValues& values,
                        const Cartridge& cartridge, GameFacts* facts, const PlaySettings& play) {
  return {values, unit.action, agent_seed(plan, unit), cartridge, play, facts};
}

PlaySettings with_cpu(PlaySettings play, CpuKind cpu) {
  play.machine.cpu = cpu;
  return play;
}

// Whether a table has so many lines, all of one unit.
bool is_table_of(const std::string& unit, std::string_view table, std::int64_t lines) {
  for (; !table.empty(); --lines) {
    const std::size_t end = table.find('\n');
    if (end == table.npos || !table.starts_with(unit + ',')) return false;
    table.remove_prefix(end + 1);
  }
  return lines == 0;
}

// Processor time of this thread: other programs do not change it.
std::int64_t microseconds() { return processor_time() / 1000; }

}  // namespace

Trial::Trial(const Plan& plan, const Unit& unit, const ResultsFolder& folder, const Cartridge& cartridge,
             GameFacts* facts, CpuKind cpu)
    : plan_(plan),
      unit_(unit),
      folder_(folder),
      length_(unit.agent->length),
      values_(unit.agent->values),
      agent_(unit.agent->kind->make(context_of(plan, unit, values_, cartridge, facts,
                                               with_cpu(play_settings(plan, *unit.agent), cpu)))),
      stage_(cartridge, with_cpu(play_settings(plan, *unit.agent), cpu), agent_->drawing()) {
  if (length_.training_episodes > 0 || length_.training_frames > 0)
    training_stage_.emplace(cartridge, with_cpu(training_settings(plan, *unit.agent), cpu),
                            agent_->drawing());
  std::filesystem::create_directories(folder_.logs(unit_.name));
  resume();
}

bool Trial::run(std::chrono::milliseconds every, const std::function<bool()>& stop,
                const std::function<void()>& on_decision) {
  on_decision_ = on_decision;
  for (auto last = Clock::now(); !is_over();) {
    if (stop()) return false;
    run_episode();
    if (is_over() || Clock::now() - last < every) continue;
    write_checkpoint();
    last = Clock::now();
  }
  finish();
  return true;
}

Trial::Place Trial::place() const {
  const double most = plan_.play.machine.max_episode_frames;
  const TrialFrames all = frames_of_trial(length_, plan_.play.machine.max_episode_frames);
  const double training =
      length_.training_frames > 0 ? static_cast<double>(account_.training_frames) : most * account_.trained;
  const double done = training + most * account_.evaluated + static_cast<double>(episode_frames_);
  return {account_.trained + account_.evaluated, decisions_,
          std::min(done / (all.training + all.evaluation), 1.0)};
}

double Trial::mean_score() const {
  return account_.evaluated == 0 ? 0 : static_cast<double>(account_.score) / account_.evaluated;
}

bool Trial::training_is_over() const {
  return account_.trained >= length_.training_episodes && account_.training_frames >= length_.training_frames;
}

bool Trial::is_over() const {
  return diverged_ || (training_is_over() && account_.evaluated >= length_.evaluation_episodes);
}

void Trial::run_episode() {
  const std::int64_t start = microseconds(), searched = agent_->searched_frames();
  const bool training = !training_is_over();
  training ? train() : evaluate();
  (training ? account_.training_microseconds : account_.evaluation_microseconds) += microseconds() - start;
  account_.searched_frames += agent_->searched_frames() - searched;
}

Episode Trial::play_episode(Stage& stage, PlayOptions options) {
  if (on_decision_)
    options.on_decision = [this](std::int64_t decisions, std::int64_t frames) {
      decisions_ = decisions;
      episode_frames_ = frames;
      on_decision_();
    };
  Episode episode = play(*agent_, stage, options);
  decisions_ = episode_frames_ = 0;
  return episode;
}

void Trial::train() {
  const int number = account_.trained + 1;
  const std::int64_t remaining = length_.training_frames > 0
                                     ? length_.training_frames - account_.training_frames
                                     : std::numeric_limits<std::int64_t>::max();
  agent_->set_learning(true);
  training_stage_->begin(environment_seed(plan_, unit_, true, number));
  const Episode episode =
      play_episode(*training_stage_, {.most_frames = remaining, .lives_end = lives_end(plan_)});
  account_.trained = number;
  account_.training_frames += episode.end.frames;
  account_.frames += episode.end.frames;
  curves_ += curve_line(unit_, number, episode.end);
  if (episode.diverged) diverge();
}

// The trial has one row, and no logs.
void Trial::diverge() {
  diverged_ = true;
  rows_ = line_of(row_of_divergence(plan_, unit_));
  std::filesystem::remove_all(folder_.logs(unit_.name));
}

void Trial::evaluate() {
  const int number = account_.evaluated + 1;
  agent_->set_learning(false);
  stage_.begin(environment_seed(plan_, unit_, false, number));
  const Episode episode = play_episode(stage_, {});
  account_.evaluated = number;
  account_.frames += episode.end.frames;
  if (episode.diverged) return diverge();  // sums of finite weights can exceed the range, too
  account_.score += episode.end.score;
  keep_log(episode, number);
}

void Trial::keep_log(const Episode& episode, int number) {
  EpisodeLog log;
  log.game = unit_.game->name;
  log.image_md5 = unit_.game->image_md5;
  log.settings = words_of(stage_.settings(), stage_.machine());
  log.origin = {unit_.name, unit_.agent_name, unit_.trial, number, agent_seed(plan_, unit_), plan_.version};
  log.end = episode.end;
  log.hashes = episode.hashes;
  log.actions = episode.actions;
  const std::string bytes = bytes_of(log);
  replace_file(folder_.log(unit_.name, std::to_string(number)), bytes, Durable::kLater);
  rows_ += line_of(row_of(log, sha256_of(bytes)));
}

void Trial::resume() {
  const std::string path = folder_.checkpoint(unit_.name);
  if (!std::filesystem::exists(path)) return;
  const std::string bytes = read_sealed(kCheckpoint, path);
  try {
    StateReader in(bytes);
    in.get(account_);
    check_account();
    in.get(rows_);
    in.get(curves_);
    check_tables();
    agent_->read(in);
    if (!in.at_end()) throw InvalidInput("it holds more than the agent reads");
  } catch (const InvalidInput& error) {
    throw InvalidInput("checkpoint " + path + ": " + error.what() +
                       "; another unit or another version of the program wrote it. Remove it, and its unit "
                       "begins anew");
  }
}

// With other counts, a trial would not end, or count beyond the range of numbers.
void Trial::check_account() const {
  const auto is_within = [](std::int64_t number, std::int64_t least, std::int64_t most) {
    return least <= number && number <= most;
  };
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max() / 2;
  const std::int64_t trained = std::max(length_.training_episodes, length_.training_frames);
  bool is_valid = is_within(account_.trained, 0, trained) &&
                  is_within(account_.evaluated, 0, length_.evaluation_episodes) &&
                  is_within(account_.training_frames, 0, account_.frames) &&
                  is_within(account_.score, -kMax, kMax);
  for (const std::int64_t count : {account_.frames, account_.training_microseconds,
                                   account_.evaluation_microseconds, account_.searched_frames})
    is_valid = is_valid && is_within(count, 0, kMax);
  if (!is_valid) throw InvalidInput("its counts of episodes, frames and times are invalid");
}

// The results would have the episodes of another unit.
void Trial::check_tables() const {
  if (!is_table_of(unit_.name, curves_, account_.trained) ||
      !is_table_of(unit_.name, rows_, account_.evaluated))
    throw InvalidInput("its tables are not those of " + std::to_string(account_.trained) + " training and " +
                       std::to_string(account_.evaluated) + " evaluation episodes of " + unit_.name);
}

void Trial::write_checkpoint() const {
  StateWriter out;
  out.put(account_);
  out.put(rows_);
  out.put(curves_);
  agent_->write(out);
  replace_file(folder_.checkpoint(unit_.name), seal(kCheckpoint, out.bytes()), Durable::kNow);
}

// The results come last: where they are, the unit is finished.
void Trial::finish() {
  const auto seconds = [](std::int64_t number) { return std::to_string(static_cast<double>(number) / 1e6); };
  const std::string times = unit_.name + ',' + seconds(account_.training_microseconds) + ',' +
                            std::to_string(account_.training_frames) + ',' +
                            seconds(account_.evaluation_microseconds) + ',' +
                            std::to_string(account_.frames - account_.training_frames) + ',' +
                            std::to_string(account_.searched_frames) + '\n';
  replace_file(folder_.unit(unit_.name, "times"), times, Durable::kLater);
  replace_file(folder_.unit(unit_.name, "curves"), curves_, Durable::kLater);
  replace_file(folder_.unit(unit_.name, "results"), rows_, Durable::kNow);
  std::filesystem::remove(folder_.checkpoint(unit_.name));
}

}  // namespace racebeam

#include "protocol/line/session_log.hpp"

#include <utility>

#include "games/game/actions.hpp"
#include "protocol/line/context.hpp"
#include "protocol/line/reply.hpp"
#include "recording/phrase_seed.hpp"

namespace racebeam {
namespace {

// `load` takes 0 for a random seed, and ALE takes the one behind the largest for the time of day.
constexpr std::uint32_t kMaxSeed = 0xFFFFFFFE;

std::string words_without_seed(const PlaySettings& settings, const Environment& machine) {
  return settings_without_seed(words_of(settings_of_log(settings, machine), machine));
}

std::size_t size_of(const EpisodeLog& log) {
  constexpr std::size_t kText = 1024;
  return kText + log.actions.capacity() + sizeof(float) * log.strengths.capacity() +
         sizeof(std::uint64_t) * log.hashes.capacity();
}

}  // namespace

// The difficulty is always among them, since setting it resets the machine after power-on, as a reset with a
// seed does.
PlaySettings settings_of_log(const PlaySettings& loaded, const Environment& machine) {
  PlaySettings settings = loaded;
  settings.autoreset = Autoreset::kDisabled;
  if (loaded.life_loss != LifeLoss::kRestart) settings.life_loss = LifeLoss::kIgnored;
  settings.machine.random_seed = machine.settings().random_seed;
  settings.difficulty = machine.difficulty();
  settings.mode.reset();
  if (machine.mode() != machine.game().default_mode) settings.mode = machine.mode();
  return settings;
}

SessionLog::SessionLog(Order order, const PlaySettings& settings, std::shared_ptr<LogWriter> writer,
                       Slot& slot, Pacer& pacer, std::shared_ptr<MemoryBudget> memory)
    : order_(std::move(order)),
      settings_(settings),
      first_settings_(words_without_seed(settings, slot.environment())),
      writer_(std::move(writer)),
      slot_(slot),
      pacer_(pacer),
      memory_(std::move(memory)) {
  watch();
}

SessionLog::~SessionLog() { slot_.set_watcher(nullptr); }

void SessionLog::drop_log(std::string why) {
  if (!is_playing_) return;
  is_playing_ = false;
  std::vector<std::uint8_t>().swap(actions_);
  std::vector<float>().swap(strengths_);
  why_not_ = std::move(why);
  ++counts_.unlogged;
}

void SessionLog::await(Pacer& pacer) {
  if (!writer_) return;
  is_awaited_ = true;
  while (writer_->is_behind()) pacer.pause();
  is_awaited_ = false;
}

const EpisodeLog& SessionLog::last() const {
  if (!why_not_.empty()) throw RequestError(ErrorCode::kNoLog, "the last episode has no log: " + why_not_);
  return *last_;
}

std::optional<Recording::Cut> SessionLog::new_cut() {
  const auto cut = writer_ ? writer_->cut() : std::nullopt;
  return cut && !std::exchange(has_reported_, true) ? cut : std::nullopt;
}

std::size_t SessionLog::footprint() const {
  return sizeof *this + actions_.capacity() + sizeof(float) * strengths_.capacity() +
         (last_ ? size_of(*last_) : 0);
}

std::uint32_t SessionLog::seed_of_phrase_now() const {
  return seed_of_phrase(order_.phrase, slot_.environment().game().name, order_.origin.trial,
                        counts_.logged + 1);
}

std::uint32_t SessionLog::next_seed() {
  if (!order_.phrase.empty()) return seed_of_phrase_now();
  const std::uint32_t seed = slot_.environment().settings().random_seed;
  return seed < kMaxSeed ? seed + 1 : 1;
}

void SessionLog::began() {
  leave();
  is_playing_ = true;
  account_ = {};
  actions_.clear();
  strengths_.clear();
  const Environment& machine = slot_.environment();
  const std::uint32_t seed = machine.settings().random_seed;
  if (!order_.phrase.empty() && seed != seed_of_phrase_now())
    return drop_log("its seed is " + std::to_string(seed) + "; the phrase gives " +
                    std::to_string(seed_of_phrase_now()));
  if (seed == 0 || seed > kMaxSeed)
    return drop_log("its seed is " + std::to_string(seed) + "; a log takes 1 to " + std::to_string(kMaxSeed));
  if (const std::string words = words_without_seed(settings_, machine); words != first_settings_)
    drop_log("its settings are '" + words + "'; those of the log are '" + first_settings_ + "'");
}

void SessionLog::leave() {
  if (account_.decisions() > 0) drop_log("it was left before its end");
}

void SessionLog::played(const Act& act, int frames) {
  if (!is_playing_) return;
  if (act.b != Act{}.b) return drop_log("player B acted in it; a log has the actions of player A");
  const bool turns = act.strength_a != Act{}.strength_a || !strengths_.empty();
  if (const int most = turns ? kMaxTurns : kMaxDecisions; account_.decisions() >= most)
    return drop_log("it has more than " + std::to_string(most) + (turns ? " acts with strengths" : " acts"));
  if (turns) {
    strengths_.resize(actions_.size(), Act{}.strength_a);
    strengths_.push_back(act.strength_a);
  }
  actions_.push_back(static_cast<std::uint8_t>(act.a));
  account_.add(slot_.environment(), frames);
  if (slot_.environment().game_over()) finish_episode();
}

void SessionLog::finish_episode() {
  const Environment& machine = slot_.environment();
  const PlaySettings settings = settings_of_log(settings_, machine);
  EpisodeLog log;
  log.game = machine.game().name;
  log.image_md5 = machine.image().md5;
  log.settings = words_of(settings, machine);
  log.origin = order_.origin;
  log.origin.episode = counts_.logged + 1;
  log.end = account_.finish(machine, settings.life_loss);
  log.hashes = account_.take_hashes();
  log.actions = std::exchange(actions_, {});
  log.strengths = std::exchange(strengths_, {});
  if (writer_) write(log);
  if (!is_playing_) return;  // it could not be written
  is_playing_ = false;
  last_ = std::move(log);
  why_not_.clear();
  ++counts_.logged;
}

// Waits for the log before it, so that one log at a time is in memory beside the last.
void SessionLog::write(EpisodeLog log) {
  await(pacer_);
  if (writer_->cut()) return drop_log("the logs before it have reached a limit, or the disk is full");
  const auto charge = std::make_shared<MemoryShare>(memory_);
  charge->set(3 * size_of(log));  // itself, its contents as text, and these deflated
  writer_->add(std::move(log), charge);
}

void add_log_cut(Context& context, Reply& reply) {
  if (!context.media.log) return;
  if (const auto cut = context.media.log->new_cut()) reply.add("log_ended", name_of(*cut));
}

}  // namespace racebeam

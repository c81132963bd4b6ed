// How a slot's episodes begin.
#include <algorithm>

#include "environment/input/play_noops.hpp"
#include "environment/vector/slot.hpp"

namespace racebeam {
namespace {

constexpr int kFire = 1;  // the action's number

// Counts begin_episode() and begin_life() while they run.
class Beginning {
 public:
  explicit Beginning(int& depth) : depth_(depth) { ++depth_; }
  ~Beginning() { --depth_; }
  Beginning(const Beginning&) = delete;
  Beginning& operator=(const Beginning&) = delete;

 private:
  int& depth_;
};

}  // namespace

// With Steps::kActs, the environment has begun an episode already. That suffices unless the settings have a
// mode, which takes effect at the next reset, a difficulty, or no-ops.
void Slot::set_up() {
  if (settings_.mode) environment_.set_mode(*settings_.mode);
  if (settings_.difficulty) environment_.set_difficulty(*settings_.difficulty);
  progress_.lives = environment_.lives();
  if (settings_.steps == Steps::kActs && !settings_.mode && !settings_.difficulty && settings_.noop_max == 0)
    return;
  begin_episode();
}

void Slot::reset(std::optional<std::uint32_t> seed) {
  const bool may_fail = pace_ != nullptr || settings_.mode.has_value();
  std::optional<Saved> before;
  if (may_fail) before = save(true, true);
  const Outcome outcome = outcome_;
  const std::optional<std::uint32_t> next_seed = next_seed_;
  std::optional<Environment> replaced;
  if (!seed) seed = next_seed;
  if (!seed && watcher_ != nullptr && !progress_.game_continues) seed = watcher_->next_seed();
  try {
    if (seed) replaced = reload(*seed);
    progress_.game_continues && !seed ? begin_life() : begin_episode();
  } catch (...) {
    if (replaced) environment_ = std::move(*replaced);
    if (before) put_back(*before);
    next_seed_ = next_seed;
    outcome_ = outcome;
    throw;
  }
  next_seed_.reset();
  if (seed && watcher_ != nullptr) watcher_->began();
}

Environment Slot::reload(std::uint32_t seed) {
  const int mode = environment_.mode(), difficulty = environment_.difficulty();
  Environment replaced = environment_.reload(seed);
  noops_ = Noops(seed, settings_.noop_max);
  if (mode != environment_.mode()) environment_.set_mode(mode);
  if (difficulty != environment_.difficulty()) environment_.set_difficulty(difficulty);
  return replaced;
}

void Slot::begin_episode() {
  const std::int64_t frames_before = pace_ != nullptr ? pace_->frames() : 0;
  const Beginning beginning(begins_);
  skip_drawing();
  environment_.reset_game();
  const bool fire = has_fire();
  bool stepped = false;
  switch (settings_.reset_order) {
    case ResetOrder::kFireNoops:
      if (fire) press_fire();
      run_noops(noops_.draw() - fire);
      break;
    case ResetOrder::kNoopsFire: run_noops_and_fire(fire); break;
    case ResetOrder::kBaselines:
      run_noops(settings_.noop_max > 0 ? noops_.draw() + 1 : 0);
      stepped = fire && press_as_baselines();
      break;
  }
  environment_.begin_audio();
  begin_progress();
  begin_stack(false, stepped);
  if (pace_ != nullptr) reset_frames_ = std::max(reset_frames_, pace_->frames() - frames_before);
}

// The game continues with the next life. The no-ops are those of the model: none in ALE, a new draw in
// EnvPool, one step in Stable-Baselines3.
void Slot::begin_life() {
  const int game = game_start();
  const Progress before = progress_;
  const Beginning beginning(begins_);
  const bool fire = has_fire();
  skip_drawing();
  switch (settings_.reset_order) {
    case ResetOrder::kFireNoops:
      if (fire) press_fire();
      break;
    case ResetOrder::kNoopsFire: run_noops_and_fire(fire); break;
    case ResetOrder::kBaselines:
      run_noops(settings_.machine.frame_skip);
      if (fire) press_as_baselines();
      break;
  }
  if (environment_.game_over()) return begin_episode();
  const bool continues = game_start() == game;
  environment_.begin_audio();
  begin_progress();
  if (continues) {
    progress_.score = before.score;
    progress_.elapsed = before.elapsed;
  }
  begin_stack(continues, settings_.reset_order == ResetOrder::kBaselines);
}

// Returns the number of the frame at which the current game began, which differs between two games.
int Slot::game_start() const {
  return frames_between(environment_.episode_frame_number(), environment_.frame_number());
}

void Slot::begin_progress() {
  progress_ = {};
  progress_.lives = environment_.lives();
  outcome_.lives_lost = 0;
  check_ends();
}

// stepped: a whole step came last, so that the screen may be seen as the brighter of two frames.
void Slot::begin_stack(bool continues, bool stepped) {
  progress_.blends = stepped && pools();
  if (!stack_) return;
  const bool keeps = settings_.stack_start == StackStart::kRepeats && continues;
  if (!keeps) stack_->clear();
  push_screen(progress_.blends);
  if (settings_.stack_start == StackStart::kRepeats && !keeps) stack_->repeat();
}

// Lets the frames before an episode run without pixels. The last one is drawn if it is read. With
// Steps::kActs, the client's choice of Drawing stays in force.
void Slot::skip_drawing() {
  if (settings_.steps == Steps::kFrames) environment_.set_drawing(Drawing::kNone);
}

bool Slot::has_fire() const {
  return settings_.fire_at_reset && std::ranges::find(actions_, kFire) != actions_.end();
}

void Slot::run_noops(int frames) { play_noops(environment_, frames); }

void Slot::run_noops_and_fire(bool fire) {
  run_noops(noops_.draw() + 1 - fire);
  if (fire) press_fire();
}

void Slot::press_fire() { environment_.act_for(1, kFire); }

// Plays a step of each of the first two actions after NOOP, as Stable-Baselines3 does, if the first one is
// FIRE. Returns whether it is.
bool Slot::press_as_baselines() {
  if (actions_.size() < 3 || actions_[1] != kFire) return false;
  for (const int action : {actions_[1], actions_[2]}) {
    environment_.act_for(settings_.machine.frame_skip, action);
    if (environment_.game_over()) environment_.reset_game();
  }
  return true;
}

}  // namespace racebeam

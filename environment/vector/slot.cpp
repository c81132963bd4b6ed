#include "environment/vector/slot.hpp"

#include <algorithm>
#include <string>

#include "environment/act_parts.hpp"
#include "environment/input/has_paddles.hpp"
#include "environment/saved_state.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

void require(bool good, const std::string& sentence) {
  if (!good) throw InvalidInput(sentence);
}

const SlotSettings& checked(const SlotSettings& settings) {
  if (settings.steps == Steps::kActs) return settings;
  const Settings& machine = settings.machine;
  require(machine.frame_skip >= 1,
          "a step has " + std::to_string(machine.frame_skip) + " frames; it must have 1 or more");
  require(machine.frame_skip_max <= machine.frame_skip, "a step of frames has a fixed number of them");
  require(!machine.truncate_on_life_loss,
          "a step of frames takes only life_loss for the effect of lost lives");
  require(!machine.color_averaging, "a step of frames has no colour averaging; it takes max_pool");
  return settings;
}

// With Steps::kFrames each frame is an act, to which the limits of a step do not apply.
Settings machine_settings(const SlotSettings& settings) {
  Settings machine = settings.machine;
  if (settings.steps == Steps::kActs) {
    machine.truncate_on_life_loss |= settings.life_loss == LifeLoss::kRestart;
    return machine;
  }
  machine.frame_skip = 1;
  machine.frame_skip_max = 0;
  machine.max_episode_frames = 0;
  return machine;
}

// EnvPool and Stable-Baselines3 play the step to its end, and then look at the lives.
bool stops_at_lost_life(const SlotSettings& settings) {
  if (settings.life_loss == LifeLoss::kEnd) return settings.reset_order == ResetOrder::kFireNoops;
  return settings.life_loss == LifeLoss::kRestart;
}

std::string described(const StackSettings& stack) {
  if (stack.depth == 0) return "no stack of screens";
  return "a stack of " + std::to_string(stack.depth) + (stack.rgb ? " colour" : " grey") + " screens of " +
         std::to_string(stack.width) + " x " + std::to_string(stack.height);
}

}  // namespace

Ends ends_of(const Environment& machine, LifeLoss life_loss) {
  if (life_loss != LifeLoss::kRestart) return {machine.terminal(), machine.truncated()};
  const int limit = machine.settings().max_episode_frames;
  const bool too_long = limit > 0 && machine.episode_frame_number() >= limit;
  return {machine.terminal() || (machine.truncated() && !too_long), too_long};
}

Slot::Slot(const Cartridge& cartridge, const SlotSettings& settings, Pace* pace)
    : settings_(checked(settings)),
      pace_(pace),
      environment_(cartridge.image, cartridge.game, machine_settings(settings), pace),
      actions_(actions_of(settings.action_set, environment_.game(), properties_of(environment_))),
      noops_(settings.machine.random_seed, settings.noop_max) {
  environment_.make_all_audio(settings.all_audio);
  set_up();
  begin_request();
}

void Slot::begin_request() {
  outcome_ = {};
  environment_.begin_audio();
  check_ends();
}

void Slot::check_ends() {
  if (settings_.steps == Steps::kActs) check_lives();
  outcome_.game_over = environment_.terminal();
  outcome_.terminated = progress_.terminated;
  outcome_.truncated = progress_.truncated;
  outcome_.finished = finished();
}

// Updates the progress of an episode whose steps are acts. A lost life counts once in an act, at its end.
void Slot::check_lives() {
  const Ends ends = ends_of(environment_, settings_.life_loss);
  const bool lost_life = outcome_.lives_lost > 0 && environment_.lives() > 0;
  const bool by_life = settings_.life_loss == LifeLoss::kEnd && (progress_.game_continues || lost_life);
  progress_.terminated =
      ends.terminated || by_life || (settings_.life_loss == LifeLoss::kReported && lost_life);
  progress_.truncated = ends.truncated;
  progress_.game_continues = by_life && !environment_.game_over();
  progress_.finished = by_life || environment_.game_over();
}

void Slot::end_episode(std::optional<std::uint32_t> seed) {
  progress_.finished = true;
  progress_.game_continues = false;
  if (seed) next_seed_ = seed;
  check_ends();
}

bool Slot::finished() const {
  return progress_.finished || (settings_.steps == Steps::kActs && environment_.game_over());
}

void Slot::act(const Act& act) { settings_.steps == Steps::kActs ? run_act(act) : run_frames(act); }

void Slot::run_act(const Act& act) {
  const int before = environment_.frame_number();
  if (!progress_.game_continues) environment_.act(act);
  const int frames = frames_between(before, environment_.frame_number());
  if (frames == 0) {  // no reward, even if reward_min is above 0
    outcome_.over = outcome_.acts == 0;
    return;
  }
  progress_.elapsed += frames;
  outcome_.lives_lost += std::max(0, progress_.lives - environment_.lives());
  progress_.lives = environment_.lives();
  add_outcome(environment_.raw_rewards(), frames);
  progress_.blends = frames > 1;
  if (stack_) push_screen(progress_.blends);
  if (watcher_ != nullptr) watcher_->played(act, frames);
}

void Slot::add_outcome(Environment::RawRewards rewards, int frames) {
  outcome_.reward += clamped(rewards.a, settings_.machine);
  outcome_.reward_b += clamped(rewards.b, settings_.machine);
  outcome_.raw_reward += rewards.a;
  progress_.score += rewards.a;
  outcome_.raw_reward_b += rewards.b;
  outcome_.frames += frames;
  ++outcome_.acts;
  check_ends();
}

void Slot::run_frames(const Act& act) {
  if (progress_.finished) {
    outcome_.over = outcome_.acts == 0;
    return;
  }
  const int frames = settings_.machine.frame_skip, limit = settings_.machine.max_episode_frames;
  const int frames_to_draw = frames_drawn(drawing_, frames);
  const bool life_stops = stops_at_lost_life(settings_);
  Environment::RawRewards rewards;
  bool over = false, lost = false, too_long = false;
  int remaining = frames;
  for (;; --remaining) {
    environment_.set_drawing(remaining <= frames_to_draw ? Drawing::kLast : Drawing::kNone);
    environment_.act(act);
    rewards.a += environment_.raw_rewards().a;
    rewards.b += environment_.raw_rewards().b;
    ++progress_.elapsed;
    over = environment_.game_over();
    lost = 0 < environment_.lives() && environment_.lives() < progress_.lives;
    too_long = limit > 0 && progress_.elapsed >= limit;
    progress_.finished = over || too_long || (life_stops && lost);
    if (progress_.finished || remaining == 1) break;
  }
  progress_.finished |= lost && settings_.life_loss == LifeLoss::kEnd;
  outcome_.lives_lost += std::max(0, progress_.lives - environment_.lives());
  progress_.lives = environment_.lives();
  progress_.game_continues = settings_.life_loss == LifeLoss::kEnd && lost && !over && !too_long;
  progress_.terminated = over || (settings_.life_loss != LifeLoss::kIgnored && lost);
  progress_.truncated = too_long && !progress_.terminated;
  progress_.blends = pools() && (remaining == 1 || settings_.reset_order == ResetOrder::kFireNoops);
  add_outcome(rewards, frames - remaining + 1);
  if (stack_) observe_end_of_step(remaining);
}

// Pushes the last frame onto the stack, pooled with the one before it if both are the last two of a full
// step. A pooled step that ends earlier pushes what the step before it showed. remaining: frames of the step
// that remain, the one that has just run included.
void Slot::observe_end_of_step(int remaining) {
  if (progress_.finished && settings_.reset_order == ResetOrder::kFireNoops)
    return observe_as_reference(remaining);
  if (pools() && remaining > 2) return stack_->push();
  push_screen(progress_.blends);
}

// The reference reads the last frame but one of a step, and the last, until the episode is over. Frames that
// it does not read are replaced by those that it read last.
void Slot::observe_as_reference(int remaining) {
  if (remaining == 1 && pools()) stack_->pool_with_previous(environment_);
  stack_->push();
}

void Slot::push_screen(bool pooled) {
  stack_->look(environment_, pooled);
  stack_->push();
}

void Slot::set_drawing(Drawing drawing) {
  if (stack_) drawing = std::min(drawing, pools() ? Drawing::kLastTwo : Drawing::kLast);
  drawing_ = drawing;
  environment_.set_drawing(drawing);
}

void Slot::set_stack(const std::optional<StackSettings>& settings) {
  std::optional<ScreenStack> stack;
  if (settings && settings->depth > 0) stack.emplace(*settings, environment_);
  stack_ = std::move(stack);
  set_drawing(drawing_);
  if (stack_) push_screen(progress_.blends);
}

Slot::Saved Slot::save(bool with_random, bool with_noops) const {
  Saved saved{environment_.save(with_random), {}, with_random, progress_};
  if (stack_) {
    saved.stack = stack_->bytes();
    saved.stack_settings = stack_->settings();
  }
  if (with_noops) saved.noops = std::make_shared<const MersenneTwister>(noops_.generator());
  return saved;
}

void Slot::restore(const Saved& saved) {
  put_back(saved);
  if (watcher_ != nullptr) watcher_->restored();
}

void Slot::put_back(const Saved& saved) {
  environment_.restore(*saved.machine);
  progress_ = saved.progress;
  next_seed_.reset();
  progress_.lives = environment_.lives();
  outcome_.lives_lost = 0;
  if (environment_.terminal()) progress_.finished = progress_.terminated = true;
  if (settings_.steps == Steps::kActs) progress_.game_continues &= settings_.life_loss == LifeLoss::kEnd;
  if (saved.noops) noops_.set_generator(*saved.noops);
  check_ends();
  if (!stack_) return;
  stack_->look(environment_, progress_.blends);
  if (stack_->settings() == saved.stack_settings) return stack_->set_bytes(saved.stack);
  stack_->clear();
  stack_->push();
}

void Slot::check_stack(const Saved& saved) const {
  if (!stack_ || stack_->settings() == saved.stack_settings) return;
  throw InvalidInput("the state has " + described(saved.stack_settings) + "; here, one has " +
                     described(stack_->settings()));
}

std::size_t Slot::Saved::footprint() const {
  constexpr std::size_t kName = 256;
  const std::size_t picture = static_cast<std::size_t>(machine->height) * kScreenWidth;
  const std::size_t generators =
      (noops ? sizeof *noops : 0) + (machine->random ? sizeof *machine->random : 0);
  return kName + sizeof *machine + machine->cartridge_ram.size() + 2 * picture + stack.size() + generators;
}

}  // namespace racebeam

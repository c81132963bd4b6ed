#include "environment/vector/lane.hpp"

#include <algorithm>

namespace racebeam {
namespace {

constexpr int kNoop = 0, kFire = 1;

// The frames of a step are acts of their own, so that lives and ends are looked at after each.
Settings one_frame_an_act(const BatchSettings& settings, std::size_t number) {
  const Settings defaults;
  Settings machine = settings.machine;
  machine.random_seed += static_cast<std::uint32_t>(number);
  machine.frame_skip = 1;
  machine.frame_skip_max = 0;
  machine.reward_min = defaults.reward_min;
  machine.reward_max = defaults.reward_max;
  machine.max_episode_frames = 0;
  machine.truncate_on_life_loss = false;
  return machine;
}

}  // namespace

Lane::Lane(const Cartridge& cartridge, const BatchSettings& settings, std::size_t number)
    : settings_(settings),
      number_(number),
      environment_(cartridge.image, cartridge.game, one_frame_an_act(settings, number)),
      actions_(settings.all_legal_actions ? &environment_.game().legal_actions
                                          : &environment_.game().minimal_actions),
      noops_(environment_.settings().random_seed, settings.noop_max),
      resize_(small_screen_maker(environment_.height())),
      grey_(grey_table(environment_.format())),
      pooled_(settings.stack > 0 ? environment_.screen().size() : 0) {
  if (settings.mode) environment_.set_mode(*settings.mode);
  if (settings.difficulty) environment_.set_difficulty(*settings.difficulty);
}

void Lane::reset(BatchResults& results) {
  begin_episode(results);
  results.rewards[number_] = 0;
  results.terminated[number_] = results.truncated[number_] = 0;
}

void Lane::begin_episode(BatchResults& results) {
  environment_.reset_game();
  const bool fire = settings_.fire_at_reset && std::ranges::find(*actions_, kFire) != actions_->end();
  if (fire) environment_.act(kFire);
  for (int noops = noops_.draw() - fire; noops > 0; --noops) {
    environment_.act(kNoop);
    if (environment_.game_over()) environment_.reset_game();
  }
  elapsed_ = 0;
  lives_ = environment_.lives();
  finished_ = false;
  if (settings_.stack > 0) {
    std::ranges::fill(stack(results.observations), std::uint8_t{0});
    make_grey(environment_.screen(), grey_, pooled_);
    push(results);
  }
  tell(results);
}

void Lane::step(int action, BatchResults& results) {
  if (finished_ && settings_.autoreset == Autoreset::kNextStep) return reset(results);
  if (finished_) {  // and stays so
    results.rewards[number_] = 0;
    return;
  }
  play((*actions_)[static_cast<std::size_t>(action)], results);
  const bool finished = finished_;
  if (finished && settings_.autoreset == Autoreset::kSameStep) {
    std::ranges::copy(stack(results.observations), stack(results.final_observations).begin());
    begin_episode(results);
    results.finished[number_] = 1;
  }
}

void Lane::play(int action, BatchResults& results) {
  std::int64_t reward = 0;
  bool over = false, lost = false, too_long = false;
  int left = settings_.frame_skip;
  for (;; --left) {
    environment_.set_drawing(left <= looked_at() ? Drawing::kLast : Drawing::kNone);
    reward += environment_.act(action);
    ++elapsed_;
    over = environment_.game_over();
    lost = 0 < environment_.lives() && environment_.lives() < lives_;
    too_long = settings_.max_episode_frames > 0 && elapsed_ >= settings_.max_episode_frames;
    finished_ = over || too_long || (settings_.life_loss_ends && lost);
    if (finished_ || left == 1) break;
  }
  lives_ = environment_.lives();
  if (settings_.stack > 0) {
    look(left);
    push(results);
  }
  const bool terminated = over || ((settings_.life_loss_ends || settings_.life_loss_is_told) && lost);
  if (settings_.clip_rewards) reward = std::clamp<std::int64_t>(reward, -1, 1);
  results.rewards[number_] = static_cast<std::int32_t>(reward);
  results.terminated[number_] = terminated;
  results.truncated[number_] = too_long && !terminated;
  tell(results);
}

// How many of a step's last frames are looked at, unless it ends before them.
int Lane::looked_at() const {
  if (settings_.stack > 0) return pools() ? 2 : 1;
  return settings_.screens ? 1 : 0;
}

bool Lane::pools() const { return settings_.max_pool && settings_.frame_skip > 1; }

// What the small screen is made of. The reference looks at the last frame but one and at the last, and not any
// more once the episode is over, so that what it saw before takes their place. left: of the step's frames, with the
// one that was just run.
void Lane::look(int left) {
  if (!finished_) {
    pools() ? make_brighter_grey(environment_.screen(), environment_.previous_screen(), grey_, pooled_)
          : make_grey(environment_.screen(), grey_, pooled_);
  } else if (left == 1 && pools()) {
    const auto before = environment_.previous_screen();
    for (std::size_t i = 0; i < pooled_.size(); ++i) pooled_[i] = std::max(pooled_[i], grey_[before[i]]);
  }
}

void Lane::push(BatchResults& results) {
  const auto small_screens = stack(results.observations);
  std::shift_left(small_screens.begin(), small_screens.end(), kSmallSize);
  resize_(pooled_, small_screens.last(kSmallSize));
}

std::span<std::uint8_t> Lane::stack(std::vector<std::uint8_t>& of) const {
  const std::size_t size = static_cast<std::size_t>(settings_.stack) * kSmallSize;
  return std::span(of).subspan(number_ * size, size);
}

void Lane::tell(BatchResults& results) const {
  results.finished[number_] = finished_;
  results.lives[number_] = environment_.lives();
  results.frames[number_] = environment_.frame_number();
  results.episode_frames[number_] = environment_.episode_frame_number();
  std::ranges::copy(environment_.ram(), &results.ram[number_ * kRamSize]);
  if (results.screens.empty()) return;
  const std::size_t room = results.screens.size() / results.lives.size();
  std::ranges::copy(environment_.screen(), &results.screens[number_ * room]);
}

}  // namespace racebeam

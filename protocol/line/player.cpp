#include "protocol/line/player.hpp"

#include <algorithm>

#include "environment/saved_state.hpp"

namespace racebeam {

Player::Player(const Cartridge& cartridge, const PlaySettings& settings, std::vector<Field> fields,
               Pacer& pacer)
    : pacer_(pacer),
      machine_(cartridge.image, cartridge.game, settings.machine, &pacer),
      noops_(settings.machine.random_seed, settings.noop_max),
      view_({}, machine_.height()) {
  for (const int action : actions_of(settings.action_set, machine_.game())) allowed_ |= 1U << action;
  if (settings.mode) machine_.set_mode(*settings.mode);
  if (settings.difficulty) machine_.set_difficulty(*settings.difficulty);
  if (settings.mode || settings.difficulty || settings.noop_max > 0) begin_episode();
  observe(std::move(fields));
  begin_request();
}

// Measured: 190 to 240 KiB, and 80 more where objects flicker (docs/performance.md).
std::size_t Player::footprint(const std::vector<Field>& fields) {
  constexpr std::size_t kMachine = std::size_t{384} << 10;
  return kMachine + View::footprint(fields);
}

std::size_t Place::footprint() const {
  constexpr std::size_t kName = 256;
  const std::size_t picture = static_cast<std::size_t>(machine->height) * kScreenWidth;
  return kName + sizeof *machine + machine->cartridge_ram.size() + 2 * picture + stack.size();
}

void Player::begin_request() {
  outcome_ = {};
  look_at_ends();
}

void Player::look_at_ends() {
  outcome_.terminated = machine_.terminal();
  outcome_.truncated = machine_.truncated();
}

void Player::act(const Action& action) {
  const int before = machine_.frame_number();
  machine_.act(action.a, action.b, action.strength_a, action.strength_b);
  const int frames = frames_between(before, machine_.frame_number());
  if (frames == 0) {  // no reward, even where each is raised to a least one
    outcome_.over = outcome_.acts == 0;
    return;
  }
  const auto [reward, reward_b] = machine_.rewards();
  outcome_.reward += reward;
  outcome_.reward_b += reward_b;
  outcome_.frames += frames;
  ++outcome_.acts;
  look_at_ends();
  blends_ = frames > 1;
  view_.acted(machine_, frames);
}

// A mode may not come about, and a request may exceed its frames.
void Player::reset() {
  const Place before = place(true);
  const Outcome outcome = outcome_;
  try {
    begin_episode();
  } catch (...) {
    go_to(before);
    outcome_ = outcome;
    throw;
  }
}

void Player::begin_episode() {
  const std::int64_t frames_before = pacer_.frames();
  machine_.reset_game();
  for (int noops = noops_.draw(); noops > 0; --noops) {
    machine_.act_for(1, 0);
    if (machine_.game_over()) machine_.reset_game();
  }
  look_at_ends();
  blends_ = false;
  view_.began(machine_, blends_);
  reset_frames_ = std::max(reset_frames_, pacer_.frames() - frames_before);
}

Place Player::place(bool with_random) const {
  Place place{machine_.save(with_random), {}, with_random, blends_};
  if (const SmallScreens* stack = view_.stack()) {
    place.stack.assign(stack->bytes().begin(), stack->bytes().end());
  }
  return place;
}

void Player::go_to(const Place& place) {
  machine_.restore(*place.machine);
  blends_ = place.blends;
  look_at_ends();
  SmallScreens* stack = view_.stack();
  if (stack == nullptr) return;
  if (stack->bytes().size() == place.stack.size()) {
    stack->set_bytes(place.stack);
  } else {
    view_.began(machine_, blends_);
  }
}

void Player::observe(std::vector<Field> fields) {
  machine_.set_drawing(drawing_of(fields, machine_.settings().color_averaging));
  view_ = View(std::move(fields), machine_.height());
  view_.began(machine_, blends_);
}

}  // namespace racebeam

#include "protocol/player.hpp"

#include <algorithm>

namespace racebeam {

Player::Player(const Cartridge& cartridge, const PlaySettings& settings, std::vector<Field> fields)
    : machine_(cartridge.image, cartridge.game, settings.machine),
      noop_max_(settings.noop_max),
      noop_random_(settings.machine.random_seed),
      view_({}, machine_.height()) {
  for (const int action : actions_of(settings.action_set, *cartridge.game)) allowed_ |= 1U << action;
  if (settings.mode) machine_.set_mode(*settings.mode);
  if (settings.difficulty) machine_.set_difficulty(*settings.difficulty);
  if (settings.mode || settings.difficulty || noop_max_ > 0) reset();
  observe(std::move(fields));
  begin_request();
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
  outcome_.reward += machine_.act(action.a, action.b, action.strength_a, action.strength_b);
  const int frames = machine_.frame_number() - before;
  outcome_.frames += frames;
  outcome_.acts += frames > 0;
  look_at_ends();
  view_.acted(machine_, frames);
}

void Player::reset() {
  machine_.reset_game();
  for (int noops = draw_noops(); noops > 0; --noops) {
    machine_.act_for(1, 0);
    if (machine_.game_over()) machine_.reset_game();
  }
  look_at_ends();
  view_.began(machine_);
}

// As the reference's vector environment draws (spec: environment.md, section 15), so that the same seed gives
// the same episodes.
int Player::draw_noops() {
  if (noop_max_ == 0) return 0;
  const auto choices = static_cast<std::uint32_t>(noop_max_);
  const std::uint32_t uneven = -choices % choices;  // 2^32 mod choices
  std::uint64_t product;
  do {
    product = std::uint64_t{static_cast<std::uint32_t>(noop_random_())} * choices;
  } while (static_cast<std::uint32_t>(product) < uneven);
  return static_cast<int>(product >> 32);
}

Place Player::place(bool with_random) const {
  Place place{machine_.save(with_random), {}, with_random};
  if (const SmallScreens* stack = view_.stack()) {
    place.stack.assign(stack->bytes().begin(), stack->bytes().end());
  }
  return place;
}

void Player::go_to(const Place& place) {
  machine_.restore(*place.machine);
  look_at_ends();
  SmallScreens* stack = view_.stack();
  if (stack == nullptr) return;
  if (stack->bytes().size() == place.stack.size()) {
    stack->set_bytes(place.stack);
  } else {
    view_.began(machine_);
  }
}

void Player::observe(std::vector<Field> fields) {
  view_ = View(std::move(fields), machine_.height());
  view_.began(machine_);
}

}  // namespace racebeam

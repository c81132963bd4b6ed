// One agent step (docs/spec/environment.md, 4 and 5).
#include <algorithm>

#include "environment/act_parts.hpp"
#include "environment/impl.hpp"

namespace racebeam {

int Environment::act(int a, int b, float strength_a, float strength_b) {
  const Presses presses{{a, strength_a}, {b, strength_b}};
  impl_->legal.check(presses);
  return impl_->act(presses);
}

bool Environment::accepts(const Act& act) const {
  return is_action(act.a) && is_action_of_b(act.b) && impl_->legal.has_a(act.a) && impl_->legal.has_b(act.b);
}

int Environment::act_for(int frames, int a, int b, float strength_a, float strength_b) {
  const Presses presses{{a, strength_a}, {b, strength_b}};
  impl_->legal.check(presses);
  return impl_->act(presses, frames);
}

int Environment::Impl::frames_of_act() {
  const int least = std::max(settings.frame_skip, 1);
  if (settings.frame_skip_max <= least) return least;
  const auto choices = static_cast<std::uint32_t>(settings.frame_skip_max - least + 1);
  return least + static_cast<int>(std::uint64_t{random()} * choices >> 32);
}

int Environment::Impl::act(const Presses& presses, int frames) {
  const int frames_to_draw = frames_drawn(drawing, frames);
  std::int64_t reward_a = 0, reward_b = 0;
  for (int n = frames; n > 0; --n) {
    sticky.draw(random, presses, play.held);
    if (over()) continue;
    run_frame(legal.replace(play.held), n <= frames_to_draw || each_frame);
    count_frame();
    observe_ram();
    reward_a += rule.reward();
    reward_b += rule.reward_b();
    if (makes_all_audio) make_audio();
    if (each_frame) each_frame();
  }
  if (!makes_all_audio) make_audio();
  raw_rewards = {reward_a, reward_b};
  play.rewards = {clamped(reward_a, settings), clamped(reward_b, settings)};
  return play.rewards[0];
}

void Environment::Impl::make_audio() {
  if (!settings.sound) return;
  console.sound().generate(audio);
  if (makes_all_audio) all_audio.insert(all_audio.end(), audio.begin(), audio.end());
}

void Environment::Impl::run_frame(const Presses& presses, bool draw) {
  play.switches.act(presses.a.action);
  controller_input.press(console.inputs(), presses, play.switches, play.paddles);
  step_console(draw);
  rule.step(memory());
}

void Environment::Impl::step_console(bool draw) {
  frame_continues = console.frame_is_open();
  if (frame_continues) {
    const auto picture = console.picture();
    open_picture.assign(picture.begin(), picture.end());
  }
  console.step(draw);
  play.ram_is_stale = 0;
  blend_is_due = true;
}

void Environment::Impl::count_frame() {
  ++play.frames;
  ++play.episode_frames;
}

// Byte after byte, so that the last one stays on the bus.
void Environment::Impl::observe_ram() { console.read_ram(kRamSize - 1); }

bool Environment::Impl::truncated() const {
  const auto episode_frames = static_cast<std::int32_t>(play.episode_frames);
  if (settings.max_episode_frames > 0 && episode_frames >= settings.max_episode_frames) return true;
  return settings.truncate_on_life_loss && rule.lives() < lives_at_start;
}

Memory Environment::Impl::memory() const {
  const auto peek = [](const void* machine, std::uint16_t address) {
    return static_cast<const Console*>(machine)->peek(address);
  };
  return {console.ram().data(), peek, &console};
}

}  // namespace racebeam

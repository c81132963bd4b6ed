// The way to the first frame of an episode (docs/spec/environment.md, 7).
#include "emulator/cartridge/cartridge.hpp"
#include "environment/impl.hpp"
#include "games/game/mode_program.hpp"

namespace racebeam {
namespace {

constexpr int kBootFrames = 60, kResetFrames = 4;
constexpr int kNoop = 0;

}  // namespace

void Environment::Impl::reset() {
  play.episode_frames = 0;
  play.paddles = controller_input.middle();
  play.switches.moved = 0;
  all_audio.clear();
  console.reset();
  // The first frame repeats this.
  controller_input.press(console.inputs(), {}, play.switches, play.paddles);
  if (!may_copy_reset()) return run_reset();
  const ResetStart start = reset_start();
  if (const auto end = reset_cache().find(start)) return copy_reset(*end);
  const std::uint32_t frames_before = play.frames;
  drew_at_reset = false;
  run_reset();
  if (!drew_at_reset) reset_cache().keep(start, reset_end(play.frames - frames_before));
}

// A reset must not be copied if its result depends on something that ResetStart does not contain.
bool Environment::Impl::may_copy_reset() const {
  return settings.copy_resets && !settings.classic && console.cartridge_ram().empty() &&
         !rule.keeps_variables();
}

ResetStart Environment::Impl::reset_start() {
  if (!boot_facts) boot_facts = analyze_boot(console, scheme_of(*image->bytes, properties.scheme).name);
  ResetStart start{image,
                   game,
                   controller_input.limits(),
                   play.mode,
                   play.switches.difficulty,
                   {},
                   console.state(),
                   console.format()};
  start.machine.drawn = 0;  // only a count of draws, and no more draws follow
  if (boot_facts->clears_ram) start.machine.riot.ram = {};
  if (boot_facts->sets_timer) start.machine.riot.timer = 0;
  if (!boot_facts->sets_sound) start.sound = console.sound().registers;
  return start;
}

ResetEnd Environment::Impl::reset_end(std::uint32_t frames) const {
  return {console.state(), console.sound().registers, rule.state(), play.paddles, frames, console.pictures()};
}

void Environment::Impl::copy_reset(const ResetEnd& end) {
  State machine = end.machine;
  machine.drawn = console.state().drawn;
  console.restore(machine);
  console.restore_pictures(end.pictures);
  console.sound().registers = end.sound;
  rule.restore(end.rule);
  play.frames += end.frames;
  play.episode_frames = end.frames;
  play.paddles = end.paddles;
  play.held = {};
  play.rewards = {};
  raw_rewards = {};
  play.ram_is_stale = 0;
  blend_is_due = true;
  frame_continues = false;
}

void Environment::Impl::run_reset() {
  run_frames(kNoop, kBootFrames);
  soft_reset();
  rule.reset();
  set_up_mode();
  soft_reset();
  for (const int action : game->starting_actions) run_frames(action, 1);
  play.rewards = {};
  raw_rewards = {};
  frame_continues = false;
}

// Between these frames, only the rule uses the bus (docs/spec/console.md, 4).
void Environment::Impl::run_frames(int action, int count) {
  Presses presses;
  presses.a.action = action;
  for (int n = 0; n < count; ++n) {
    run_frame(presses, false);
    if (const auto read = rule.last_byte()) console.read_ram(*read);
  }
  observe_ram();
}

void Environment::Impl::soft_reset() {
  run_frames(kResetAction, kResetFrames);
  if (!settings.classic) play.held = {};
}

// Holds SELECT for `frames` frames. Only the frame after them counts, and is seen by the rule.
void Environment::Impl::select(int frames) {
  ControllerInput::press_select(console.inputs(), play.switches);
  for (int n = 0; n < frames; ++n) step_console(false);
  observe_ram();
  run_frames(kNoop, 1);
  count_frame();
}

void Environment::Impl::set_up_mode() {
  struct Host final : ModeHost {
    explicit Host(Impl& on) : impl(on) {}
    Memory memory() override { return impl.memory(); }
    void select(int frames) override { impl.select(frames); }
    void soft_reset() override { impl.soft_reset(); }

    std::uint32_t random() override {
      impl.drew_at_reset = true;
      return impl.random();
    }

    void act(int action, int count) override {
      Presses presses;
      presses.a.action = action;
      impl.drew_at_reset = true;  // for sticky actions
      for (int n = 0; n < count; ++n) impl.act(presses);
    }

    Impl& impl;
  };
  Host host(*this);
  run_mode_program(*game, rule, play.mode, host);
}

}  // namespace racebeam

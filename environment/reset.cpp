// The way to the first frame of an episode (spec: environment.md, section 7).
#include "environment/impl.hpp"
#include "games/mode_program.hpp"

namespace racebeam {
namespace {

constexpr int kBootFrames = 60, kResetFrames = 4;
constexpr int kNoop = 0;

// Adventure had one mode only in ALE 0.6, and no program for it.
bool has_mode_program(const Game& game, const Settings& settings) {
  return !settings.classic || game.name != "adventure";
}

}  // namespace

void Environment::Impl::reset() {
  play.episode_frames = 0;
  play.paddles = hands.middle();
  console.reset();
  run_frames(kNoop, kBootFrames);
  soft_reset();
  rule.reset();
  if (has_mode_program(*game, settings)) set_up_mode();
  soft_reset();
  for (const int action : game->starting_actions) run_frames(action, 1);
  play.rewards = {};
}

void Environment::Impl::run_frames(int action, int count) {
  Presses presses;
  presses.a.action = action;
  for (int n = 0; n < count; ++n) run_frame(presses, false);
}

void Environment::Impl::soft_reset() {
  run_frames(kResetAction, kResetFrames);
  if (!settings.classic) play.held = {};
}

// Only the frame after it is seen by the rule, and counts.
void Environment::Impl::select(int frames) {
  Hands::press_select(console.inputs(), play.difficulty);
  for (int n = 0; n < frames; ++n) step_console(false);
  run_frames(kNoop, 1);
  count_frame();
}

void Environment::Impl::set_up_mode() {
  struct Host final : ModeHost {
    explicit Host(Impl& on) : impl(on) {}
    Memory memory() override { return impl.memory(); }
    void select(int frames) override { impl.select(frames); }
    void soft_reset() override { impl.soft_reset(); }
    std::uint32_t random() override { return static_cast<std::uint32_t>(impl.random()); }

    void act(int action, int count) override {
      Presses asked;
      asked.a.action = action;
      for (int n = 0; n < count; ++n) impl.act(asked);
    }

    Impl& impl;
  };
  Host host(*this);
  run_mode_program(*game, rule, play.mode, host);
}

}  // namespace racebeam

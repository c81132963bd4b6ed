// One machine of a vector environment: its steps, its episodes, and the stack of screens that its agent sees.
// With the defaults it plays as the reference's vector environment does (docs/spec/environment.md, 15).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "environment/environment.hpp"
#include "environment/input/action_set.hpp"
#include "environment/input/noops.hpp"
#include "environment/observe/screen_stack.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

// What a step is.
enum class Steps {
  kFrames,  // frames, each an act of its own: lives and ends are looked at after each
  kActs     // one act of the environment, which has its own ends and its own number of frames
};

// How an episode begins.
enum class ResetOrder {
  kFireNoops,  // as in ALE's vector environment: FIRE, which counts as a no-op, then the no-ops
  kNoopsFire,  // as in EnvPool: no-ops, one more where there is no FIRE, then FIRE
  kBaselines   // as in Stable-Baselines3: at least one no-op; then a step of FIRE, and one of the next action
};

// What a lost life does to the episode.
enum class LifeLoss {
  kIgnored,
  kTold,   // the step is terminated; the episode goes on (life_loss_info)
  kEnds,   // the episode ends, and the next one goes on with the next life, as in DQN
  kResets  // the episode ends, and the next one is a new game (episodic_life)
};

// What the stack of screens is when an episode begins.
enum class StackStart {
  kZeros,   // the first screen, behind zeros
  kRepeats  // the first screen, over and over; an episode that goes on with the next life keeps the stack
};

struct SlotSettings {
  // Frames, limits of rewards and of an episode's frames are those of a step. With Steps::kFrames,
  // frame_skip_max, truncate_on_life_loss and color_averaging must not be set, and no-ops at the start don't
  // count as frames of the episode.
  Settings machine{
      .frame_skip = 4, .sticky = 0, .max_episode_frames = 108000, .reward_min = -1, .reward_max = 1};
  std::optional<int> mode, difficulty;  // the game's defaults if not given
  ActionSet action_set = ActionSet::kMinimal;

  Steps steps = Steps::kFrames;
  ResetOrder reset_order = ResetOrder::kFireNoops;
  int noop_max = 30;          // an episode begins with 0 to noop_max - 1 frames of NOOP
  bool fire_at_reset = true;  // and with FIRE, if it is in the action set
  LifeLoss life_loss = LifeLoss::kIgnored;
  StackStart stack_start = StackStart::kZeros;
  bool max_pool =
      true;  // screens of the stack are of the brighter of a step's last two frames, pixel by pixel
};

// What acts led to: those of a step, or of a request.
struct Outcome {
  std::int64_t reward = 0, reward_b = 0;          // of players A and B; each step's is clamped
  std::int64_t raw_reward = 0, raw_reward_b = 0;  // before that
  int acts = 0;
  int frames = 0;
  bool terminated = false, truncated = false;
  bool finished = false;   // the episode is over
  bool game_over = false;  // the game is, whatever lives and limits say
  bool over = false;       // nothing was done: the episode had ended before
};

class Slot {
 public:
  // Powers on and begins an episode. `pace` outlives the slot; null: none. Throws InvalidInput for settings
  // that can't be used, and what `pace` throws.
  Slot(const Cartridge& cartridge, const SlotSettings& settings, Pace* pace = nullptr);
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  Environment& environment() { return environment_; }
  const Environment& environment() const { return environment_; }
  const SlotSettings& settings() const { return settings_; }
  const std::vector<int>& actions() const { return actions_; }  // of the action set

  void begin_request();      // sums begin at 0
  void act(const Act& act);  // one step
  // Begins an episode: after a life that was lost, with LifeLoss::kEnds, the next one; else a new game. With
  // a seed, the machine is powered on anew with it, and so is the generator of no-ops. Throws InvalidInput,
  // and what the pace throws; the slot is then as it was.
  void reset(std::optional<std::uint32_t> seed = std::nullopt);

  bool finished() const;  // the episode: a step does nothing more
  const Outcome& outcome() const { return outcome_; }
  void set_outcome(const Outcome& outcome) { outcome_ = outcome; }
  std::int64_t reset_frames() const {
    return reset_frames_;
  }  // of the longest reset so far, told by the pace

  // Screens that will be looked at beside the stack: it changes nothing but the speed.
  void set_drawing(Drawing drawing);

  // A stack of screens from now on, beginning with what is there; without settings, none. Throws
  // InvalidInput.
  void set_stack(const std::optional<StackSettings>& settings);
  const ScreenStack* stack() const { return stack_ ? &*stack_ : nullptr; }
  // Whether what is there would be seen as the brighter of two frames.
  bool blends() const { return progress_.blends; }

 private:
  // What of the episode the environment does not know.
  struct Progress {
    int elapsed = 0;        // frames of play in this game
    int lives = 0;          // after the last step
    bool finished = false;  // Steps::kFrames: the episode
    bool goes_on = false;   // finished by a lost life alone: the next episode goes on with the game
    bool terminated = false, truncated = false;  // Steps::kFrames: how the last step ended
    bool blends = false;                         // the last step ran two frames or more
  };

 public:
  // A place that can be returned to. The generator of no-ops is no part of it.
  struct Saved {
    std::shared_ptr<const Environment::Saved> machine;
    std::vector<std::uint8_t> stack;  // ScreenStack::bytes(); empty: there was none
    bool with_random = false;         // the generator of what is random in play is part of it
    Progress progress;

    std::size_t footprint() const;  // bytes of memory, about; pictures that are shared count
  };
  Saved save(bool with_random) const;
  void restore(const Saved& saved);  // throws InvalidInput

 private:
  void run_act(const Act& act);
  void run_frames(const Act& act);
  void add_outcome(Environment::RawRewards rewards, int frames);
  void look_at_ends();
  void look_at_end_of_step(int left);
  void show(bool pooled);
  bool pools() const { return settings_.max_pool && settings_.machine.frame_skip > 1; }

  // slot_start.cpp
  void set_up();
  void reload(std::uint32_t seed);
  void begin_episode();
  void begin_life();
  void begin_stack(bool goes_on);
  void draw_nothing();
  void run_noops(int frames);
  void run_noops_and_fire(bool fire);  // EnvPool's order; one no-op more where there is no FIRE
  void press_fire();
  void press_as_baselines();
  bool has_fire() const;

  const SlotSettings settings_;
  Pace* const pace_;
  Environment environment_;
  const std::vector<int>& actions_;
  Noops noops_;  // with a generator of its own, as in the reference
  Outcome outcome_;
  Progress progress_;
  std::optional<ScreenStack> stack_;
  Drawing drawing_ = Drawing::kNone;
  std::int64_t reset_frames_ = 0;
};

}  // namespace racebeam

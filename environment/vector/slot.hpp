// One machine of a vector environment: its steps, its episodes, and the stack of screens that its agent sees.
// With the default settings it behaves as the reference's vector environment (docs/spec/environment.md, 15).
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

// The unit of a step.
enum class Steps {
  kFrames,  // several acts of one frame each; lives and the end of the game are checked after each
  kActs     // one act of the environment, which has its own number of frames and its own limits
};

// How an episode begins.
enum class ResetOrder {
  kFireNoops,  // as in ALE's vector environment: FIRE, which counts as a no-op, then the no-ops
  kNoopsFire,  // as in EnvPool: the no-ops, then FIRE; one no-op more if the action set has no FIRE
  kBaselines   // as in Stable-Baselines3: at least one no-op, then a step of FIRE and one of the next action
};

// What a lost life does to the episode. One that ends by it is terminated, not truncated: an agent must not
// expect rewards of the state after it.
enum class LifeLoss {
  kIgnored,
  kReported,  // the step counts as terminated, but the episode continues (ALE's life_loss_info)
  kEnd,       // the episode ends, and the next one continues the game with the next life, as in DQN
  kRestart    // the episode ends, and the next one is a new game (ALE's episodic_life)
};

struct Ends {
  bool terminated = false, truncated = false;
};
// How the machine's episode ended. kRestart sets Settings::truncate_on_life_loss, with which ALE truncates an
// episode at a lost life. Such an episode counts as terminated here.
Ends ends_of(const Environment& machine, LifeLoss life_loss);

// The stack of screens when an episode begins.
enum class StackStart {
  kZeros,   // zeros, then the first screen
  kRepeats  // only the first screen; an episode that continues with the next life keeps the stack
};

struct SlotSettings {
  // frame_skip and the limits of rewards and frames apply to a step. With Steps::kFrames, frame_skip_max,
  // truncate_on_life_loss and color_averaging must not be set, and no-ops at the start do not count as frames
  // of the episode. With Steps::kActs, LifeLoss::kRestart sets truncate_on_life_loss.
  Settings machine{
      .frame_skip = 4, .sticky = 0, .max_episode_frames = 108000, .reward_min = -1, .reward_max = 1};
  std::optional<int> mode, difficulty;  // the game's defaults if not given
  ActionSet action_set = ActionSet::kMinimal;

  Steps steps = Steps::kFrames;
  ResetOrder reset_order = ResetOrder::kFireNoops;
  int noop_max = 30;          // an episode begins with 0 to noop_max - 1 frames of NOOP
  bool fire_at_reset = true;  // and with FIRE if the action set has it
  LifeLoss life_loss = LifeLoss::kIgnored;
  StackStart stack_start = StackStart::kZeros;
  bool all_audio = false;  // make_all_audio()
  bool max_pool = true;    // each pixel of a stacked screen is the brighter of the step's last two frames
};

// The results of the acts of one step, or of one request.
struct Outcome {
  std::int64_t reward = 0, reward_b = 0;          // of players A and B: sums of each step's clamped reward
  std::int64_t raw_reward = 0, raw_reward_b = 0;  // the same before clamping
  int acts = 0;
  int frames = 0;
  int lives_lost = 0;
  bool terminated = false, truncated = false;
  bool finished = false;   // the episode is over
  bool game_over = false;  // the game itself is over; lives and limits do not count
  bool over = false;       // nothing was run, because the episode had ended before
};

// Observes what a slot plays. For logs of episodes, which begin at power-on.
class SlotWatcher {
 public:
  virtual ~SlotWatcher() = default;
  virtual std::uint32_t next_seed() = 0;  // of a reset that begins a game and is given none
  virtual void began() = 0;               // a reset powered the machine on anew, and began an episode
  virtual void played(const Act& act, int frames) = 0;  // one step of acts
  virtual void restored() = 0;                          // a state
};

class Slot {
 public:
  // Powers on and begins an episode. `pace` may be null, and must outlive the slot. Throws InvalidInput for
  // settings that cannot be used, and what `pace` throws.
  Slot(const Cartridge& cartridge, const SlotSettings& settings, Pace* pace = nullptr);
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  Environment& environment() { return environment_; }
  const Environment& environment() const { return environment_; }
  const SlotSettings& settings() const { return settings_; }
  const std::vector<int>& actions() const { return actions_; }  // of the action set

  void begin_request();      // sets the sums of outcome() to 0
  void act(const Act& act);  // one step
  // Begins an episode. After a lost life with LifeLoss::kEnd, the game continues; otherwise a new game
  // begins. A seed powers the machine on anew, and seeds the generator of no-ops, too. Throws InvalidInput,
  // and what the pace throws; the slot is then unchanged.
  void reset(std::optional<std::uint32_t> seed = std::nullopt);

  // Ends the episode, so that the next one is a new game. The next reset without a seed uses `seed`.
  // Requires Steps::kFrames.
  void end_episode(std::optional<std::uint32_t> seed);

  bool finished() const;                             // the episode is over: act() does nothing
  bool begins() const { return begins_ > 0; }        // this frame is one of those that begin an episode
  int elapsed() const { return progress_.elapsed; }  // frames of play in this game
  const Outcome& outcome() const { return outcome_; }
  std::int64_t score() const { return progress_.score; }
  void set_outcome(const Outcome& outcome) { outcome_ = outcome; }
  // The frames of the longest reset so far, as the pace counts; 0 without a pace.
  std::int64_t reset_frames() const { return reset_frames_; }

  // With Steps::kActs. Null: none; the watcher must outlive the slot, or be removed before.
  void set_watcher(SlotWatcher* watcher) { watcher_ = watcher; }

  // Which screens the caller will read beside the stack. Affects only the speed.
  void set_drawing(Drawing drawing);

  // Begins a stack of screens with the current one, or removes the stack if there are no settings. Throws
  // InvalidInput for a size that the screens cannot have.
  void set_stack(const std::optional<StackSettings>& settings);
  const ScreenStack* stack() const { return stack_ ? &*stack_ : nullptr; }
  // Whether the current screen is seen as the brighter of two frames.
  bool blends() const { return progress_.blends; }

 private:
  // The facts about the episode that the environment does not keep.
  struct Progress {
    std::int64_t score = 0;       // sum of player A's rewards in this game, before clamping
    int elapsed = 0;              // frames of play in this game
    int lives = 0;                // after the last step
    bool finished = false;        // the episode
    bool game_continues = false;  // finished only by a lost life: the next episode continues the game
    bool terminated = false, truncated = false;  // how the last step ended
    bool blends = false;  // the last step ran at least two frames, so its screen blends them
  };

 public:
  struct Saved {
    std::shared_ptr<const Environment::Saved> machine;
    std::vector<std::uint8_t> stack;  // ScreenStack::bytes(); empty if there was no stack
    bool with_random = false;         // contains the generator of the machine, as for sticky actions
    Progress progress;
    StackSettings stack_settings{.depth = 0};                // ScreenStack::settings(); depth 0: no stack
    std::shared_ptr<const MersenneTwister> noops = nullptr;  // the generator of no-ops, if it is contained

    std::size_t footprint() const;  // estimated bytes of memory; shared pictures count in full
  };
  // with_noops: with the generator of no-ops, so that later episodes are the same, too.
  Saved save(bool with_random, bool with_noops = false) const;
  // Restores a saved state. If its stack does not have the settings of this slot's, the slot begins a new
  // stack. Throws InvalidInput for a state of another image or game.
  void restore(const Saved& saved);
  // Throws InvalidInput if restore() would have to begin the stack anew.
  void check_stack(const Saved& saved) const;

 private:
  void run_act(const Act& act);
  void check_lives();
  void run_frames(const Act& act);
  void add_outcome(Environment::RawRewards rewards, int frames);
  void check_ends();
  void observe_end_of_step(int remaining);
  void observe_as_reference(int remaining);
  void push_screen(bool pooled);
  bool pools() const { return settings_.max_pool && settings_.machine.frame_skip > 1; }

  void put_back(const Saved& saved);

  // slot_start.cpp
  void set_up();
  Environment reload(std::uint32_t seed);  // returns the one that it replaces
  void begin_episode();
  void begin_life();
  int game_start() const;
  void begin_progress();
  void begin_stack(bool continues, bool stepped);
  void skip_drawing();
  void run_noops(int frames);
  void run_noops_and_fire(bool fire);  // EnvPool's order
  void press_fire();
  bool press_as_baselines();
  bool has_fire() const;

  const SlotSettings settings_;
  Pace* const pace_;
  Environment environment_;
  const std::vector<int> actions_;
  Noops noops_;                             // with its own generator, as in the reference
  std::optional<std::uint32_t> next_seed_;  // of end_episode()
  Outcome outcome_;
  Progress progress_;
  std::optional<ScreenStack> stack_;
  Drawing drawing_ = Drawing::kNone;
  SlotWatcher* watcher_ = nullptr;
  std::int64_t reset_frames_ = 0;
  int begins_ = 0;  // depth of begin_episode() and begin_life()
};

}  // namespace racebeam

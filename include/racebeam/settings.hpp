// The settings of an Environment, which do not change after its construction. They are plain values: each
// thread fills its own, and an environment copies them.
//
//     racebeam::Settings settings;
//     settings.seed = 7;
//     settings.frame_skip = 4;  // each step lasts four frames
//     settings.sticky = 0;      // and does what the agent says
//     racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"), settings);
//     environment.step(racebeam::Action::kFire);
#pragma once

#include <cstdint>
#include <limits>

#include "racebeam/config.hpp"

namespace RACEBEAM_NAMESPACE {

// The rule that computes rewards, lives and the end.
enum class Rules {
  kAle012,  // that of the Arcade Learning Environment 0.12, with its errors
  kFixed    // the corrected rule, where an error is known (docs/rules.md)
};

// The screens that the caller reads. Any other screen is drawn when it is read, which costs more.
enum class Screens {
  kOnDemand,  // few: rewards and RAM are enough
  kLast,      // the one after each step
  kLastTwo,   // previous_screen(), too
  kEvery      // those of all frames, in on_frame()
};

// Executes the game's instructions. Results do not depend on it.
enum class Cpu {
  kAuto,  // the translator, where the computer can run it
  kInterpreter,
  kTranslator
};

struct Settings {
  // The game. The defaults are those of the Arcade Learning Environment.
  std::uint32_t seed = 0;               // of sticky actions and other random numbers in play
  std::uint32_t system_seed = 4753849;  // of the contents of RAM and timer at power-on
  int frame_skip = 1;                   // frames of a step
  int frame_skip_max = 0;               // above frame_skip: each step draws its frames from this range
  float sticky = 0.25F;                 // probability that a frame repeats the action of the frame before
  Rules rules = Rules::kAle012;
  int paddle_min = -1, paddle_max = -1;  // how far paddles turn, in ohms; -1: the game's own limits

  // When an episode is truncated.
  int max_episode_frames = 0;          // frames of an episode; 0: no limit
  bool truncate_on_life_loss = false;  // a lost life truncates the episode, too

  // Observations. The reward of a step is clamped to these limits.
  int reward_min = std::numeric_limits<int>::min(), reward_max = std::numeric_limits<int>::max();
  bool color_averaging = false;  // a screen blends the last two frames
  bool sound = false;            // each step generates audio()

  // Speed only; results do not depend on these.
  Screens screens = Screens::kLast;
  Cpu cpu = Cpu::kAuto;
};

}  // namespace RACEBEAM_NAMESPACE

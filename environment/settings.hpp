// The settings of an environment before an image is loaded (docs/spec/environment.md, 14).
#pragma once

#include <cstdint>
#include <limits>

#include "emulator/translator/translator.hpp"

namespace racebeam {

// Which rule computes rewards, end and lives from memory.
enum class Rules {
  kAle012,  // the reference's, with its errors; our own for games that it lacks
  kFixed,   // corrected ones, where there are any (docs/rules.md)
};

struct Settings {
  Rules rules = Rules::kAle012;
  std::uint32_t random_seed = 0;        // seeds the sticky-action generator
  std::uint32_t system_seed = 4753849;  // seeds power-on RAM and timer
  int frame_skip = 1;                   // frames an act lasts, at least 1
  int frame_skip_max = 0;      // above frame_skip: each act draws its number of frames from this range
  float sticky = 0.25F;        // probability that a frame repeats the action before
  int max_episode_frames = 0;  // 0: no limit
  bool truncate_on_life_loss = false;
  int reward_min = std::numeric_limits<int>::min();
  int reward_max = std::numeric_limits<int>::max();
  bool color_averaging = false;
  bool copy_resets = true;  // where the result is the same; false: run each reset (reset_cache.hpp)
  bool sound = false;       // produce the 512 audio samples of each act
  int paddle_min = -1;      // -1: the built-in limits, or the game's
  int paddle_max = -1;
  CpuKind cpu = CpuKind::kAuto;  // what executes instructions; affects speed only
  // Plays as ALE 0.4 to 0.6: one generator for machine and sticky actions, sticky actions persist over a
  // reset, and so on (docs/spec/classic-protocol.md, 6).
  bool classic = false;
};

}  // namespace racebeam

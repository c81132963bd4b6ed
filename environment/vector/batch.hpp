// Many machines, of one game or of several, stepped together on a few threads. With the defaults it shows what
// ale_py.vector_env.AtariVectorEnv of ALE 0.12 shows, byte for byte (docs/spec/environment.md, 15), as
// tests/environment/vector/test_batch.py checks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "environment/environment.hpp"
#include "environment/vector/autoreset.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

struct BatchSettings {
  // Of all machines. random_seed is the first machine's; the n-th after it has n more. Not looked at are
  // frame_skip and frame_skip_max, reward_min and reward_max, max_episode_frames and truncate_on_life_loss,
  // for which there are others here. Colour averaging is refused.
  Settings machine{.sticky = 0};
  std::optional<int> mode, difficulty;  // the game's defaults if not given

  int frame_skip = 4;               // frames of a step, at least 1
  int max_episode_frames = 108000;  // of play, no-ops apart; 0: no limit
  int noop_max = 30;                // an episode begins with 0 to noop_max - 1 frames of NOOP
  bool fire_at_reset = true;        // and with FIRE before them, which counts as one, if the game has it
  bool clip_rewards = true;         // to -1, 0, 1
  bool life_loss_ends = false;      // a lost life terminates the episode (episodic_life)
  bool life_loss_is_told = false;   // a lost life sets `terminated`; the episode goes on (life_loss_info)
  bool all_legal_actions = false;   // actions are indices into the legal ones instead of the minimal ones
  Autoreset autoreset = Autoreset::kNextStep;

  int stack = 4;         // small screens of an observation, at least 1; 0: none are made
  bool max_pool = true;  // small screens are of the brighter of the last two frames, pixel by pixel
  bool screens = false;  // give out screens too
  unsigned threads = 0;  // 0: one for each processor that the process may use
};

// One array each, the machines one after the other. Their memory stays where it is.
struct BatchResults {
  std::vector<std::uint8_t> observations;  // machines x stack x 84 x 84, grey, oldest first
  std::vector<std::uint8_t> final_observations;  // the same, of ended episodes, with Autoreset::kSameStep only
  std::vector<std::uint8_t> screens;  // machines x tallest height x 160 palette indices, if asked for
  std::vector<std::uint8_t> ram;      // machines x 128
  std::vector<std::int32_t> rewards;
  std::vector<std::uint8_t> terminated, truncated;
  std::vector<std::uint8_t> finished;  // the episode is over: what Autoreset goes by
  std::vector<std::int32_t> lives, frames, episode_frames;  // as Environment counts them
};

class Batch {
 public:
  // A machine for each cartridge, powered on and reset: `results` are those of the resets. Throws
  // std::invalid_argument, in a sentence, for what can't be used.
  Batch(std::span<const Cartridge> cartridges, const BatchSettings& settings);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;
  int height() const;  // rows of a screen in the results; those of lower machines are followed by zeros

  // The actions of a machine: player A's numbers, of which a step's action is an index.
  const std::vector<int>& actions(std::size_t machine) const;

  // One action each. Throws std::invalid_argument, and does nothing, when there are not as many actions as
  // machines or one is not an index. Nothing is allocated, but at first: a reset from each value of the
  // timer, a buffer that was not used before; and records of lines where objects begin to flicker (emulator/tia/line_cache/flicker.hpp).
  void step(std::span<const int> actions);

  // New episodes, for those machines whose byte is not 0; without an argument, for all. Generators go on.
  void reset();
  void reset(std::span<const std::uint8_t> chosen);

  const BatchResults& results() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

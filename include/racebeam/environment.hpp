// A machine that plays one game: actions go in; rewards, screens, RAM and the end of the episode come out.
// One thread at a time may use an Environment, or several its const functions; different ones need no locks.
//
//     racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"));
//     std::vector<std::uint8_t> screen(environment.observation_size(racebeam::Pixels::kRgb));
//     int score = 0;
//     environment.reset(7);  // the seed of this episode
//     while (!environment.episode_over()) {
//       environment.observe(racebeam::Pixels::kRgb, screen);  // 210 rows of 160 pixels
//       const bool fires = screen[0] < 128;                   // the agent's policy
//       score += environment.step(fires ? racebeam::Action::kFire : racebeam::Action::kRight);
//     }
//     std::cout << "score " << score << " after " << environment.episode_frames() << " frames\n";
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "racebeam/action.hpp"
#include "racebeam/config.hpp"
#include "racebeam/game.hpp"
#include "racebeam/image.hpp"
#include "racebeam/settings.hpp"
#include "racebeam/snapshot.hpp"

namespace RACEBEAM_NAMESPACE {

inline constexpr int kScreenWidth = 160;
inline constexpr int kRamSize = 128;
inline constexpr int kAudioSize = 512;  // samples of a frame

enum class Pixels {
  kPalette,  // the console's own colour numbers, a byte for each pixel
  kGrey,     // brightness, a byte for each pixel
  kRgb       // red, green and blue
};

// The rewards of the last step; those of player B are 0 if the game's rule has only one player.
struct Rewards {
  int a = 0, b = 0;                   // between Settings::reward_min and reward_max
  std::int64_t raw_a = 0, raw_b = 0;  // without these limits; 0 after a restore
};

// Functions that may finish what a step left for later, such as drawing a picture, are not const.
class RACEBEAM_API Environment {
 public:
  // Powers a console on and begins an episode. The first form recognises the game of the image
  // (Game::recognise). Both throw Error for settings or an image that cannot be used.
  explicit Environment(const Image& image, const Settings& settings = {});
  Environment(const Image& image, const Game& game, const Settings& settings = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  // A step plays Settings::frame_skip frames and returns player A's reward. Once the episode is over, it does
  // nothing and returns 0. It throws Error for numbers that are not actions. A reset with a seed powers the
  // console on anew, so that the episode can be repeated; without one, the random numbers continue. It throws
  // Error, and the environment stays as it was, if the image does not reach the mode.
  int step(Action a, Action b = Action::kNoop);
  int step(const Controls& controls);
  void reset(std::optional<std::uint32_t> seed = std::nullopt);

  // Results of the last step.
  Rewards rewards() const;
  int lives() const;
  bool terminated() const;    // the game is over
  bool truncated() const;     // a limit of the settings ended the episode
  bool episode_over() const;  // either of the two
  int frames() const;         // since power-on
  int episode_frames() const;

  // The screen: height() rows of 160 pixels, from the top. observe() throws Error unless `out` has
  // observation_size() bytes. Spans are valid until the next step, reset or restore.
  int height() const;
  std::size_t observation_size(Pixels pixels) const;
  void observe(Pixels pixels, std::span<std::uint8_t> out);
  std::span<const std::uint8_t> screen();           // Pixels::kPalette, without a copy
  std::span<const std::uint8_t> previous_screen();  // of the frame before it; never averaged

  // Other observations: memory, sound and the frames of a step.
  std::span<const std::uint8_t, kRamSize> ram() const;
  void set_ram(int index, std::uint8_t value);              // throws Error unless the index is 0 to 127
  std::span<const std::uint8_t, kAudioSize> audio() const;  // of the last frame; needs Settings::sound

  // Saves the current state, and restores one of the same image and game. with_random: the generator of
  // sticky actions is part of the snapshot; else it continues after a restore, as planners need.
  Snapshot save(bool with_random = false);
  void restore(const Snapshot& snapshot);  // throws Error for a snapshot of something else

  // For planners that merge equal states: two environments of the same image, game and settings with the same
  // hash show the same after the same actions. Pictures, frame numbers and generators do not count.
  std::uint64_t state_hash();

  // The choices of the game. A mode takes effect at the next reset, a difficulty at the next frame. Both
  // throw Error, which lists what the game has.
  const Game& game() const;
  void set_mode(int mode);
  void set_difficulty(int difficulty);

  // Calls the function after each frame of a step, for example to record it. An empty function stops the
  // calls. The function may read this environment, and may throw.
  void on_frame(std::function<void()> function);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace RACEBEAM_NAMESPACE

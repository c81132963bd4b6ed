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

inline constexpr int kScreenWidth = 160;  // pixels of a row
inline constexpr int kRamSize = 128;      // bytes
inline constexpr int kAudioSize = 512;    // samples of a frame: unsigned bytes, mono; 128 is silence

// The form of an observed screen.
enum class Pixels {
  kPalette,  // the console's own colour numbers, a byte for each pixel
  kGrey,     // brightness from 0 to 255, a byte for each pixel
  kRgb       // red, green and blue, three bytes for each pixel
};

// The rewards of the last step. Those of player B are 0 if the game's rule has only one player.
struct Rewards {
  int a = 0, b = 0;                   // between Settings::reward_min and reward_max
  std::int64_t raw_a = 0, raw_b = 0;  // without these limits; 0 after a restore
};

// Functions that may finish what a step left for later, such as drawing a picture, are not const. A function
// that throws Error leaves the environment as it was. Spans that functions return point into the environment,
// and are valid until the next step, reset or restore.
class RACEBEAM_API Environment {
 public:
  // Powers a console on and begins an episode. Without a game, it plays that of the image (Game::recognise).
  // Throws Error for an image, a game or settings that cannot be used.
  explicit Environment(const Image& image, const Settings& settings = {});
  Environment(const Image& image, const Game& game, const Settings& settings = {});
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  // Plays Settings::frame_skip frames in which player A holds action `a`, and player B action `b`. Returns
  // the reward of player A for these frames, within the limits of the settings. Once the episode is over, it
  // does nothing and returns 0. Throws Error for an action that the player does not have.
  int step(Action a, Action b = Action::kNoop);

  // Plays a step with these controls: it may have its own number of frames. Throws Error also for the
  // strength of a paddle that is not a finite number.
  int step(const Controls& controls);

  // Begins an episode, in the mode and the difficulty that were set. A seed powers the console on anew, so
  // that the episode can be repeated. Without one, the random numbers continue. Throws Error if the image
  // does not reach the mode.
  void reset(std::optional<std::uint32_t> seed = std::nullopt);

  // The results of the last step.
  Rewards rewards() const;
  int lives() const;           // 0 for a game without lives
  bool terminated() const;     // the game is over
  bool truncated() const;      // a limit of the settings ended the episode
  bool episode_over() const;   // terminated() or truncated()
  int frames() const;          // since power-on
  int episode_frames() const;  // since the episode began

  // Rows of a screen. It depends on the game's television standard, and never changes.
  int height() const;

  // Bytes that observe() writes: height() rows of 160 pixels, of one byte or three.
  std::size_t observation_size(Pixels pixels) const;

  // Writes the screen to `out`, row by row from the top. Throws Error unless `out` has observation_size()
  // bytes.
  void observe(Pixels pixels, std::span<std::uint8_t> out);

  // Return the screen, and that of the frame before it, as Pixels::kPalette and without a copy. Colour
  // averaging does not affect previous_screen().
  std::span<const std::uint8_t> screen();
  std::span<const std::uint8_t> previous_screen();

  // Returns the console's RAM, from address $80 on.
  std::span<const std::uint8_t, kRamSize> ram() const;

  // Changes a byte of RAM. Throws Error unless `index` is 0 to 127.
  void set_ram(int index, std::uint8_t value);

  // Returns the sound of the last frame, at 30720 samples a second (PAL and SECAM: 25600). Zeros without
  // Settings::sound.
  std::span<const std::uint8_t, kAudioSize> audio() const;

  // Returns the present state. with_random: the snapshot contains the generator of sticky actions. Otherwise
  // the generator continues after a restore, as planners need.
  Snapshot save(bool with_random = false);

  // Replaces the state by a saved one. Throws Error if the snapshot is of another image or game.
  void restore(const Snapshot& snapshot);

  // Returns a hash of the state, for planners that merge equal states. Two environments with the same image,
  // game, settings and hash show the same after the same actions. Pictures, frame numbers and generators do
  // not count.
  std::uint64_t state_hash();

  // Returns the game that the constructor recognised, or that its caller passed.
  const Game& game() const;

  // Selects one of Game::modes(), from the next reset on. Throws Error, which lists them, for another number.
  void set_mode(int mode);

  // Sets the difficulty switches to one of Game::difficulties(), from the next frame on. Throws Error, which
  // lists them, for another number.
  void set_difficulty(int difficulty);

  // Sets the function that is called after each frame of a step, for example to record it. An empty function
  // stops the calls. The function may read this environment. What it throws leaves step().
  void on_frame(std::function<void()> function);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace RACEBEAM_NAMESPACE

// An agent's view of one game: actions in; rewards, screens, RAM and the end of the episode out.
// Everything here follows ALE 0.12 (docs/spec/environment.md), where not said otherwise.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulator/pace.hpp"
#include "emulator/state/properties.hpp"
#include "environment/settings.hpp"
#include "games/game/game.hpp"
#include "games/rom_image.hpp"

namespace racebeam {

struct Sound;
class FrameBuffer;

// Which frames of an act are drawn as they run.
enum class Drawing { kEvery, kLastTwo, kLast, kNone };

constexpr int kScreenWidth = 160;
constexpr int kRamSize = 128;
constexpr int kAudioSize = 512;

// What both players ask for. a: 0-17, b: 18-35 (docs/spec/environment.md, 1). The strengths are of turning a
// paddle.
struct Act {
  int a = 0, b = 18;
  float strength_a = 1.0F, strength_b = 0.0F;
};

class Environment {
 public:
  // Powers a console on with `image` and resets `game`. Throws InvalidInput when a setting, or the
  // image, can't be used. `pace` is told of every frame and must outlive the environment; null: none.
  Environment(std::shared_ptr<const Image> image, std::shared_ptr<const Game> game, const Settings& settings,
              Pace* pace = nullptr);
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  // One agent step of `frame_skip` frames. a: 0-17, b: 18-35 (docs/spec/environment.md, 1). Returns the
  // clamped sum of rewards.
  int act(int a, int b = 18, float strength_a = 1.0F, float strength_b = 0.0F);
  int act(const Act& act) { return this->act(act.a, act.b, act.strength_a, act.strength_b); }
  // What both players got for the last act, clamped like its answer, which is `a`. `b` is 0 in games whose
  // rule has no second player.
  struct Rewards {
    int a, b;
  };
  Rewards rewards() const;
  // The same before it was clamped. It is no part of a state: 0 after a reset and after a restore.
  struct RawRewards {
    std::int64_t a = 0, b = 0;
  };
  RawRewards raw_rewards() const;
  void reset_game();  // throws InvalidInput when the image does not come to the mode that was set

  // As constructed anew with this random_seed: powered on, in the game's default mode. Drawing and watch()
  // stay.
  void reload(std::uint32_t random_seed);

  // As act(), for a number of frames that is not the settings': no-ops at the start of an episode, or a step
  // of an agent that chooses its number of frames each time.
  int act_for(int frames, int a, int b = 18, float strength_a = 1.0F, float strength_b = 0.0F);

  // Says which screens the caller will read. It changes only the speed: a screen that was not drawn is drawn
  // when it is read, which costs more. The default is kLast; it is kLastTwo with colour averaging, and kEvery
  // while watch() has a function. kLastTwo suits a caller that reads previous_screen() too, and kNone a
  // caller that reads only rewards and RAM.
  void set_drawing(Drawing drawing);
  Drawing drawing() const;

  // Gives back the memory that only makes drawing faster, some 40 KiB, or 80 where objects flicker: for one
  // that will not act for a while.
  void rest();

  // Called after each frame of an act, not for those of a reset; nothing: no longer. For recordings.
  void watch(std::function<void()> each_frame);

  // A mode takes effect at the next reset, a difficulty at the next frame. Throw InvalidInput,
  // naming what is offered.
  void set_mode(int mode);
  void set_difficulty(int difficulty);
  int mode() const;
  int difficulty() const;

  bool game_over() const;  // terminal or truncated
  bool terminal() const;
  bool truncated() const;
  int lives() const;
  int frame_number() const;          // counted frames since loading; goes on below 0 after the largest int
  int episode_frame_number() const;  // since the last reset

  int height() const;                                     // rows of the screen
  std::span<const std::uint8_t> screen() const;           // height x 160 palette indices, row-major
  std::span<const std::uint8_t> previous_screen() const;  // a frame ago; never averaged
  Format format() const;                                  // never Format::kAuto
  std::span<const std::uint8_t, kRamSize> ram() const;
  std::span<const std::uint8_t, kAudioSize> audio() const;  // of the last act; zeros without Settings::sound
  const Sound& sound() const;                               // the two channels that make it
  void set_ram(int index, std::uint8_t value);              // index 0-127, else std::out_of_range
  void screen_rgb(std::vector<std::uint8_t>& rgb) const;    // height x 160 x 3
  void screen_grey(std::vector<std::uint8_t>& grey) const;  // height x 160

  // The same into memory of the caller's, of exactly that size.
  void screen_rgb(std::span<std::uint8_t> rgb) const;
  void screen_grey(std::span<std::uint8_t> grey) const;

  const Game& game() const;
  const Image& image() const;
  const Settings& settings() const;

  // A state in memory. Restoring it gives back the picture, RAM, audio, rewards and every later frame,
  // exactly. with_random: the sticky-action generator too.
  class Saved;
  std::shared_ptr<const Saved> save(bool with_random = false) const;

  // A picture of a state that is one of this environment's image and game, with its pixels.
  std::shared_ptr<const FrameBuffer> drawn(const std::shared_ptr<FrameBuffer>& picture) const;
  void restore(const Saved& saved);

  // For planners, which reach the same state in different ways: two environments of the same image, game and
  // settings that are in the same state, and are given the same actions, show the same for ever, unless an
  // episode's limit of frames comes between. Looked at are the machine with the cartridge's RAM, paddles,
  // mode, difficulty, the actions held and the rule's variables; left out are what tells of the way and not
  // of the place: pictures, sound, counters of frames, the last act's rewards. Nor are generators looked at:
  // with sticky actions two equal states may go on differently. Less than 0.2 microseconds; Saved has the
  // same.
  std::uint64_t state_hash() const;  // see state_hash.hpp
  bool same_state(const Environment& other) const;

  // Throws InvalidInput, naming what is wrong, when acts and resets can't have led to `saved`, which is of
  // this image and game but comes from elsewhere. What passes may play nonsense, but does no harm.
  void check(const Saved& saved) const;

  // The classic server's SAVE_STATE: a state without pictures, some 2 KB, that restore_classic() alone takes.
  std::shared_ptr<const Saved> save_classic() const;

  // The classic server's LOAD_STATE: like restore, but screen and RAM answered stay those from before it
  // until the next frame, and stored sticky actions stay (docs/spec/classic-protocol.md, 4).
  void restore_classic(const Saved& saved);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Frames between two values of Environment::frame_number().
constexpr int frames_between(int earlier, int later) {
  return static_cast<int>(static_cast<std::uint32_t>(later) - static_cast<std::uint32_t>(earlier));
}

}  // namespace racebeam

// An agent's view of one game: actions in; rewards, screens, RAM and the end of the episode out. Everything
// here follows ALE 0.12 (docs/spec/environment.md), unless stated otherwise.
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

// The actions of both players: a is 0-25, b is 18-35 (docs/spec/environment.md, 1). The strengths say how
// fast a paddle is turned.
struct Act {
  int a = 0, b = 18;
  float strength_a = 1.0F, strength_b = 0.0F;
};

class Environment {
 public:
  // Powers a console on with `image` and resets `game`. Throws InvalidInput if a setting or the image cannot
  // be used. `pace` is notified of every frame; it may be null, and must outlive the environment.
  Environment(std::shared_ptr<const Image> image, std::shared_ptr<const Game> game, const Settings& settings,
              Pace* pace = nullptr);
  ~Environment();
  Environment(Environment&&) noexcept;
  Environment& operator=(Environment&&) noexcept;

  // Plays one act of the agent: Settings::frame_skip frames. a: 0-25, b: 18-35, or numbers of the
  // controllers' own (docs/spec/environment.md, 1). Returns the sum of player A's rewards, clamped. Throws
  // std::invalid_argument for an action that the machine does not have, and for a strength that is not a
  // finite number.
  int act(int a, int b = 18, float strength_a = 1.0F, float strength_b = 0.0F);
  bool accepts(const Act& act) const;  // whether this machine has both actions
  int act(const Act& act) { return this->act(act.a, act.b, act.strength_a, act.strength_b); }
  // The clamped rewards of both players for the last act; `a` is what act() returned. `b` is 0 if the game's
  // rule has no second player.
  struct Rewards {
    int a, b;
  };
  Rewards rewards() const;
  // The rewards before clamping. They are not part of a state: 0 after a reset and after a restore.
  struct RawRewards {
    std::int64_t a = 0, b = 0;
  };
  RawRewards raw_rewards() const;
  void reset_game();  // throws InvalidInput if the image does not reach the selected mode

  // Powers on anew with this random_seed, in the game's default mode, as if newly constructed. The settings
  // of set_drawing(), make_all_audio() and watch() stay. Returns the environment as it was.
  Environment reload(std::uint32_t random_seed);

  // Acts for this number of frames: for no-ops at the start of an episode, or for an agent that chooses the
  // number at each step. Otherwise as act().
  int act_for(int frames, int a, int b = 18, float strength_a = 1.0F, float strength_b = 0.0F);

  // Sets which screens the caller will read. It affects only the speed: a screen that was not drawn is drawn
  // when it is read, which costs more. The default is kLast; it is kLastTwo with colour averaging, and kEvery
  // while watch() has a function. kLastTwo suits a caller that reads previous_screen() too, and kNone a
  // caller that reads only rewards and RAM.
  void set_drawing(Drawing drawing);
  Drawing drawing() const;

  // With Settings::sound: generates samples in each frame of an act from now on, for all_audio(). audio() has
  // those of the last frame then. The default generates them once for each act, as the reference does.
  void make_all_audio(bool all);
  void begin_audio();  // empties all_audio()

  // Releases the caches of drawing, about 40 KiB, or 80 KiB if objects flicker, of a machine that will not
  // act for a while. The next frames allocate them again.
  void release_caches();

  // Bytes of memory for pictures, samples, records of lines and RAM on the cartridge. The rest is the same
  // for all machines.
  std::size_t footprint() const;
  std::size_t cartridge_ram_size() const;  // bytes of it that each saved state has

  // Sets the function that is called after each frame of an act, but not of a reset, for example to record
  // it. An empty function stops the calls.
  void watch(std::function<void()> each_frame);

  // A mode takes effect at the next reset, a difficulty at the next frame. Both throw InvalidInput, which
  // names what the game offers.
  void set_mode(int mode);
  void set_difficulty(int difficulty);
  int mode() const;
  int difficulty() const;

  bool game_over() const;  // terminal() or truncated()
  bool terminal() const;
  bool truncated() const;
  int lives() const;
  int frame_number() const;          // counted frames since loading; wraps to negative numbers
  int episode_frame_number() const;  // since the last reset

  int height() const;                                     // rows of the screen
  std::span<const std::uint8_t> screen() const;           // height x 160 palette indices, row-major
  std::span<const std::uint8_t> previous_screen() const;  // that of the frame before; never averaged
  // Which line each row of these screens shows (Console::picture_lines()). Empty if that is not known.
  std::span<const std::uint64_t> screen_lines() const;
  std::span<const std::uint64_t> previous_screen_lines() const;
  Format format() const;  // never Format::kAuto
  std::span<const std::uint8_t, kRamSize> ram() const;
  std::span<const std::uint8_t, kAudioSize> audio() const;  // of the last act; zeros without Settings::sound
  // 512 samples for each frame since begin_audio(), with make_all_audio(); empty after a reset or a restore.
  std::span<const std::uint8_t> all_audio() const;
  const Sound& sound() const;                                // the TIA's two channels
  void set_ram(int index, std::uint8_t value);               // index 0-127, else std::out_of_range
  void tia_values(std::vector<std::uint8_t>& values) const;  // emulator/tia/registers/register_values.hpp
  void screen_rgb(std::vector<std::uint8_t>& rgb) const;     // height x 160 x 3
  void screen_grey(std::vector<std::uint8_t>& grey) const;   // height x 160

  // Write into the caller's memory, which must have exactly that size.
  void screen_rgb(std::span<std::uint8_t> rgb) const;
  void screen_grey(std::span<std::uint8_t> grey) const;

  const Game& game() const;
  const Image& image() const;
  const Settings& settings() const;

  // Saves the state in memory. After restore(), the picture, RAM, audio, rewards and every later frame are
  // exactly the same. with_random: the state contains the generator of sticky actions, too.
  class Saved;
  std::shared_ptr<const Saved> save(bool with_random = false) const;

  // Saves the state in about 4 KB, for callers that do not read pictures: planners, and the classic server's
  // SAVE_STATE. restore() leaves the pictures as they are; whole frames that are drawn after it are exactly
  // the same.
  std::shared_ptr<const Saved> save_without_pictures() const;

  // Returns a picture of a state of this image and game, drawn if it was deferred.
  std::shared_ptr<const FrameBuffer> with_pixels(const std::shared_ptr<FrameBuffer>& picture) const;
  void restore(const Saved& saved);

  // For planners, which reach the same state by different paths. Two environments with the same image, game
  // and settings that are in the same state show the same after the same actions, up to an episode's limit of
  // frames. A state is the machine with the cartridge's RAM, paddles, mode, difficulty, held actions and the
  // rule's variables. Pictures, sound, frame counters and the last rewards are left out, and also generators:
  // with sticky actions, two equal states may continue differently. Takes less than 0.2 microseconds.
  std::uint64_t state_hash() const;  // see state_hash.hpp
  bool same_state(const Environment& other) const;

  // Checks a state of this image and game that comes from an untrusted source. Throws InvalidInput, which
  // names the value, if no acts and resets can lead to it. A state that passes may be nonsense, but does no
  // harm.
  void check(const Saved& saved) const;

  // The classic server's LOAD_STATE: as restore(), but screen() and ram() return the old contents until the
  // next frame, and the held actions stay (docs/spec/classic-protocol.md, 4).
  void restore_classic(const Saved& saved);

 private:
  struct Impl;
  explicit Environment(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

// Frames between two values of Environment::frame_number().
constexpr int frames_between(int earlier, int later) {
  return static_cast<int>(static_cast<std::uint32_t>(later) - static_cast<std::uint32_t>(earlier));
}

}  // namespace racebeam

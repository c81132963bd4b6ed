// The implementation of Environment. Its parts are in act.cpp, reset.cpp and save.cpp.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "emulator/base/mersenne_twister.hpp"
#include "emulator/console.hpp"
#include "environment/environment.hpp"
#include "environment/episode_state.hpp"
#include "environment/input/controller_input.hpp"
#include "environment/input/effective_actions.hpp"
#include "environment/reset/boot_analysis.hpp"
#include "environment/reset/reset_cache.hpp"
#include "environment/saved_state.hpp"
#include "games/game/rule.hpp"

namespace racebeam {

class Blend;

struct Environment::Impl {
  Impl(std::shared_ptr<const Image> image, std::shared_ptr<const Game> game, const Settings& settings,
       Pace* pace);

  const std::shared_ptr<const Image> image;
  const std::shared_ptr<const Game> game;
  const Settings settings;
  Pace* const pace;
  const Identity identity;
  const Properties properties;

  MersenneTwister random;  // of sticky actions; of the machine too, in classic mode
  const std::unique_ptr<PowerOn> power_on;
  Console console;
  Rule rule;
  const LegalActions legal;
  const Sticky sticky;
  const ControllerInput controller_input;
  const int lives_at_start;
  EpisodeState play;
  std::array<std::uint8_t, kAudioSize> audio{};
  bool makes_all_audio = false;
  std::vector<std::uint8_t> all_audio;  // since begin_audio()
  std::optional<BootFacts> boot_facts;  // of the image; studied at the first reset
  RawRewards raw_rewards;
  bool drew_at_reset = false;        // the last reset used the generator
  std::function<void()> each_frame;  // empty: no watcher
  Drawing drawing;

  // A frame that takes several steps shows one picture, which changes. open_picture is what it showed before
  // the last step.
  bool frame_continues = false;
  std::vector<std::uint8_t> open_picture;

  // With colour averaging, the screen is computed when it is first read.
  const Blend* const blend;  // null: no averaging
  std::vector<std::uint8_t> blended;
  bool blend_is_due = true;

  // act.cpp
  int act(const Presses& presses) { return act(presses, frames_of_act()); }
  int act(const Presses& presses, int frames);
  void make_audio();
  int frames_of_act();
  void run_frame(const Presses& presses, bool draw);  // and the rule after it
  void step_console(bool draw);                       // without the rule
  void count_frame();
  void observe_ram();  // reads it over the bus, as the reference's agent does after each act
  bool truncated() const;
  bool over() const { return rule.terminal() || truncated(); }
  Memory memory() const;

  // reset.cpp
  void reset();
  bool may_copy_reset() const;
  ResetStart reset_start();
  ResetEnd reset_end(std::uint32_t frames) const;
  void copy_reset(const ResetEnd& end);
  void run_reset();
  void soft_reset();
  void run_frames(int action, int count);
  void select(int frames);
  void set_up_mode();

  // save.cpp
  std::shared_ptr<const Saved> save(bool with_random) const;
  std::shared_ptr<Saved> save_without_pictures() const;
  void check(const Saved& saved) const;  // throws unless it is of this image, game and console
  void check_values(const Saved& saved) const;
  void restore(const Saved& saved);
  void restore_classic(const Saved& saved);

  StateParts parts() const { return {console.state(), play, rule.state(), console.cartridge_ram()}; }

  std::span<const std::uint8_t> screen();
};

}  // namespace racebeam

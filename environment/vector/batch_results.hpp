// The results of a Batch: arrays in the caller's memory, with a place for each machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "environment/vector/slot.hpp"

namespace racebeam {

// Memory of the caller, into which results are written. The machines follow each other in every array. An
// empty array is not written.
struct BatchArrays {
  std::span<std::uint8_t> observations;  // machines x stack x height x width [x 3], oldest first
  // With Autoreset::kSameStep, the last observation, RAM and numbers of each episode that ended in this step.
  // The places of the other machines are not written.
  std::span<std::uint8_t> final_observations, final_ram;
  std::span<std::int32_t> final_lives, final_frames, final_episode_frames;
  std::span<std::uint8_t> screens;  // machines x tallest height x 160 palette indices
  std::span<std::uint8_t> ram;      // machines x 128
  std::span<std::int32_t> rewards, rewards_b, raw_rewards, raw_rewards_b;  // of players A and B
  std::span<std::uint8_t> terminated, truncated;
  std::span<std::uint8_t> finished;   // 1: the episode is over, so Autoreset applies
  std::span<std::uint8_t> game_over;  // 1: the game is over; lives and limits do not count
  std::span<std::int32_t> lives, frames, episode_frames;  // as Environment counts them
  std::span<std::int32_t> numbers;                        // each machine's own, from 0
  // Frames of play in this game; acts of the request, none in a reset; and the lives that they lost.
  std::span<std::int32_t> elapsed, acts, lives_lost;
  // machines x audio_size(): samples of the last frame or, with SlotSettings::all_audio, of the step, after
  // which comes silence; and those of the episodes that ended. Zeros without Settings::sound.
  std::span<std::uint8_t> audio, final_audio;
};

// Bytes of sound of a machine.
std::size_t audio_size(const SlotSettings& settings);

// Owns memory for all arrays except those of the sound.
struct BatchResults {
  std::vector<std::uint8_t> observations, final_observations, final_ram;
  std::vector<std::int32_t> final_lives, final_frames, final_episode_frames;
  std::vector<std::uint8_t> screens, ram;
  std::vector<std::int32_t> rewards, rewards_b, raw_rewards, raw_rewards_b;
  std::vector<std::uint8_t> terminated, truncated, finished, game_over;
  std::vector<std::int32_t> lives, frames, episode_frames, numbers, elapsed, acts, lives_lost;

  BatchArrays arrays();
};

// The layout of results in the arrays. `position` is the place in each array.
class ResultLayout {
 public:
  ResultLayout(const StackSettings& stack, bool screens, bool finals)
      : stack_(stack), screens_(screens), finals_(finals) {}

  // The rows of a place in `screens`: those of the tallest machine. Set before anything below is called.
  void set_height(int rows) { height_ = rows; }
  int height() const { return height_; }

  std::size_t observation_size() const;  // bytes; what a lower machine leaves over is filled with zeros
  BatchResults make_results(std::size_t count) const;  // with room for `count` machines

  // What machine `number` shows now.
  void write(const Slot& slot, std::size_t number, std::size_t position, const BatchArrays& arrays) const;
  // The arrays `final_...`, of a machine whose episode has ended and which has not been reset yet.
  void write_final(const Slot& slot, std::size_t position, const BatchArrays& arrays) const;

 private:
  std::size_t whole_screen() const;    // bytes of one screen in `screens`
  std::size_t stacked_screen() const;  // and of one in a stack
  void write_stack(const Slot& slot, std::span<std::uint8_t> observations, std::size_t position) const;

  StackSettings stack_;
  bool screens_, finals_;
  int height_ = 0;
};

// The end of one episode, kept until its results are received.
class FinalResult {
 public:
  void keep(const ResultLayout& layout, const Slot& slot);
  void write(std::size_t position, const BatchArrays& arrays) const;

 private:
  std::vector<std::uint8_t> observation_;
  std::array<std::uint8_t, kRamSize> ram_{};
  std::vector<std::uint8_t> audio_;
  std::int32_t lives_ = 0, frames_ = 0, episode_frames_ = 0;
};

}  // namespace racebeam

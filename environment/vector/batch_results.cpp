#include "environment/vector/batch_results.hpp"

#include <algorithm>

namespace racebeam {
namespace {

template <typename T>
void put(std::span<T> array, std::size_t position, std::int64_t value) {
  if (!array.empty()) array[position] = static_cast<T>(value);
}

void put(std::span<std::uint8_t> array, std::size_t position, std::span<const std::uint8_t> bytes) {
  if (!array.empty()) std::ranges::copy(bytes, &array[position * bytes.size()]);
}

// What the step did not play is silent.
void put_audio(std::span<std::uint8_t> out, std::size_t position, const Slot& slot) {
  if (out.empty()) return;
  constexpr std::uint8_t kSilence = 128;
  const std::size_t size = audio_size(slot.settings());
  const Environment& environment = slot.environment();
  std::span<const std::uint8_t> samples = environment.audio();
  if (slot.settings().all_audio) samples = environment.all_audio();
  const auto own = out.subspan(position * size, size);
  const auto rest = std::ranges::copy(samples.first(std::min(size, samples.size())), own.begin()).out;
  std::fill(rest, own.end(), kSilence);
}

}  // namespace

std::size_t audio_size(const SlotSettings& settings) {
  return std::size_t{kAudioSize} *
         static_cast<std::size_t>(settings.all_audio ? settings.machine.frame_skip : 1);
}

BatchArrays BatchResults::arrays() {
  return {observations,
          final_observations,
          final_ram,
          final_lives,
          final_frames,
          final_episode_frames,
          screens,
          ram,
          rewards,
          rewards_b,
          raw_rewards,
          raw_rewards_b,
          terminated,
          truncated,
          finished,
          game_over,
          lives,
          frames,
          episode_frames,
          numbers,
          elapsed,
          acts,
          lives_lost,
          {},
          {}};
}

std::size_t ResultLayout::whole_screen() const { return static_cast<std::size_t>(height_) * kScreenWidth; }

std::size_t ResultLayout::stacked_screen() const {
  const int rows = stack_.height == 0 ? height_ : stack_.height;
  const int columns = stack_.width == 0 ? kScreenWidth : stack_.width;
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns) *
         static_cast<std::size_t>(stack_.channels());
}

std::size_t ResultLayout::observation_size() const {
  return static_cast<std::size_t>(stack_.depth) * stacked_screen();
}

BatchResults ResultLayout::make_results(std::size_t count) const {
  BatchResults results;
  results.observations.resize(count * observation_size());
  if (finals_) {
    results.final_observations.resize(count * observation_size());
    results.final_ram.resize(count * kRamSize);
    for (auto* numbers : {&results.final_lives, &results.final_frames, &results.final_episode_frames})
      numbers->resize(count);
  }
  if (screens_) results.screens.resize(count * whole_screen());
  results.ram.resize(count * kRamSize);
  for (auto* numbers : {&results.rewards, &results.rewards_b, &results.raw_rewards, &results.raw_rewards_b,
                        &results.lives, &results.frames, &results.episode_frames, &results.numbers,
                        &results.elapsed, &results.acts, &results.lives_lost})
    numbers->resize(count);
  for (auto* flags : {&results.terminated, &results.truncated, &results.finished, &results.game_over})
    flags->resize(count);
  return results;
}

void ResultLayout::write_stack(const Slot& slot, std::span<std::uint8_t> observations,
                               std::size_t position) const {
  if (observations.empty() || slot.stack() == nullptr) return;
  const std::size_t stride = stacked_screen(), size = observation_size();
  const auto own = observations.subspan(position * size, size);
  const ScreenStack& stack = *slot.stack();
  stack.copy_to(own, stride);
  if (stack.screen_size() == stride) return;
  for (std::size_t at = 0; at < own.size(); at += stride)
    std::ranges::fill(own.subspan(at + stack.screen_size(), stride - stack.screen_size()), std::uint8_t{0});
}

void ResultLayout::write(const Slot& slot, std::size_t number, std::size_t position,
                         const BatchArrays& arrays) const {
  const Environment& environment = slot.environment();
  const Outcome& outcome = slot.outcome();
  put(arrays.rewards, position, outcome.reward);
  put(arrays.rewards_b, position, outcome.reward_b);
  put(arrays.raw_rewards, position, outcome.raw_reward);
  put(arrays.raw_rewards_b, position, outcome.raw_reward_b);
  put(arrays.terminated, position, outcome.terminated);
  put(arrays.truncated, position, outcome.truncated);
  put(arrays.finished, position, outcome.finished);
  put(arrays.game_over, position, outcome.game_over);
  put(arrays.lives, position, environment.lives());
  put(arrays.frames, position, environment.frame_number());
  put(arrays.episode_frames, position, environment.episode_frame_number());
  put(arrays.numbers, position, static_cast<std::int64_t>(number));
  put(arrays.elapsed, position, slot.elapsed());
  put(arrays.acts, position, outcome.acts);
  put(arrays.lives_lost, position, outcome.lives_lost);
  put(arrays.ram, position, environment.ram());
  put_audio(arrays.audio, position, slot);
  write_stack(slot, arrays.observations, position);
  if (arrays.screens.empty()) return;
  const auto own = arrays.screens.subspan(position * whole_screen(), whole_screen());
  const auto rest = std::ranges::copy(environment.screen(), own.begin()).out;
  std::fill(rest, own.end(), std::uint8_t{0});
}

void ResultLayout::write_final(const Slot& slot, std::size_t position, const BatchArrays& arrays) const {
  write_stack(slot, arrays.final_observations, position);
  put(arrays.final_ram, position, slot.environment().ram());
  put_audio(arrays.final_audio, position, slot);
  put(arrays.final_lives, position, slot.environment().lives());
  put(arrays.final_frames, position, slot.environment().frame_number());
  put(arrays.final_episode_frames, position, slot.environment().episode_frame_number());
}

void FinalResult::keep(const ResultLayout& layout, const Slot& slot) {
  observation_.resize(layout.observation_size());
  BatchArrays own;
  own.final_observations = observation_;
  own.final_ram = ram_;
  audio_.resize(audio_size(slot.settings()));
  own.final_audio = audio_;
  own.final_lives = {&lives_, 1};
  own.final_frames = {&frames_, 1};
  own.final_episode_frames = {&episode_frames_, 1};
  layout.write_final(slot, 0, own);
}

void FinalResult::write(std::size_t position, const BatchArrays& arrays) const {
  put(arrays.final_lives, position, lives_);
  put(arrays.final_frames, position, frames_);
  put(arrays.final_episode_frames, position, episode_frames_);
  put(arrays.final_ram, position, ram_);
  put(arrays.final_audio, position, audio_);
  put(arrays.final_observations, position, observation_);
}

}  // namespace racebeam

// A vector environment on threads, whose results are arrays: what programs in the same process use. With the
// defaults it shows what ale_py.vector_env.AtariVectorEnv of ALE 0.12 shows, byte for byte
// (docs/spec/environment.md, 15), as tests/environment/vector/test_batch.py checks.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "environment/vector/vector_environment.hpp"

namespace racebeam {

struct BatchSettings {
  SlotSettings slot;
  Autoreset autoreset = Autoreset::kNextStep;
  StackSettings stack;
  bool screens = false;        // give out whole screens too
  std::size_t batch_size = 0;  // machines whose results one receive() has; 0: all

  unsigned threads = 0;      // 0: one for each processor that the process may use
  int first_processor = -1;  // ThreadPool's
  std::chrono::microseconds busy_poll{50};
};

// Where results go, the machines one after the other: memory of the caller. An empty array is not written.
struct BatchArrays {
  std::span<std::uint8_t> observations;  // machines x stack x height x width [x 3], oldest first
  // The same of the episodes that ended, with Autoreset::kSameStep; the other machines' parts are not
  // written.
  std::span<std::uint8_t> final_observations, final_ram;
  std::span<std::int32_t> final_lives, final_frames, final_episode_frames;  // the same
  std::span<std::uint8_t> screens;  // machines x tallest height x 160 palette indices
  std::span<std::uint8_t> ram;      // machines x 128
  std::span<std::int32_t> rewards, rewards_b, raw_rewards, raw_rewards_b;  // of players A and B
  std::span<std::uint8_t> terminated, truncated;
  std::span<std::uint8_t> finished;                       // the episode is over: what Autoreset goes by
  std::span<std::uint8_t> game_over;                      // the game is, whatever lives and limits say
  std::span<std::int32_t> lives, frames, episode_frames;  // as Environment counts them
  std::span<std::int32_t> numbers;                        // of the machines
};

// Memory for all of them.
struct BatchResults {
  std::vector<std::uint8_t> observations, final_observations, final_ram;
  std::vector<std::int32_t> final_lives, final_frames, final_episode_frames;
  std::vector<std::uint8_t> screens, ram;
  std::vector<std::int32_t> rewards, rewards_b, raw_rewards, raw_rewards_b;
  std::vector<std::uint8_t> terminated, truncated, finished, game_over;
  std::vector<std::int32_t> lives, frames, episode_frames, numbers;

  BatchArrays arrays();
};

// Throws InvalidInput if so many machines take more memory than the process may use.
void check_memory(std::size_t machines);

class Batch {
 public:
  // A machine for each cartridge, powered on and reset. Throws InvalidInput, in a sentence, for what can't be
  // used.
  Batch(std::span<const Cartridge> cartridges, const BatchSettings& settings);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;
  std::size_t batch_size() const;
  int height() const;  // rows of a screen in the results; those of lower machines are followed by zeros
  std::size_t observation_size() const;  // bytes of a machine's
  unsigned threads() const;
  BatchResults make_results() const;  // of batch_size() machines

  // A machine's, of which a step's action is an index: player A's numbers.
  const std::vector<int>& actions(std::size_t machine) const;
  // A machine: for its states, and what else it can tell. Throws InvalidInput while it plays, from send() to
  // receive().
  Slot& slot(std::size_t machine);

  // One act each; `out` is of all machines. Throws InvalidInput, and does nothing, when there are not as many
  // as machines, or when one is not an index. Nothing is allocated, but at first: a reset from each value of
  // the timer, a buffer that was not used before; and records of lines where objects begin to flicker
  // (emulator/tia/line_cache/flicker_detector.hpp).
  void step(std::span<const Act> acts, const BatchArrays& out);
  void step(std::span<const int> actions, const BatchArrays& out);  // indices

  // New episodes, for those machines whose byte is not 0; empty: for all. A seed of a machine from 0 on
  // powers it on anew; with a negative one, or none, generators go on.
  void reset(const BatchArrays& out, std::span<const std::uint8_t> chosen = {},
             std::span<const std::int64_t> seeds = {});

  // What the machines show now.
  void show(const BatchArrays& out) const;

  // The same in two halves, for batch_size() below size(): while some machines play, the caller works with
  // the results of others. send() begins a step of each machine of `machines`, none of which plays;
  // send_resets() begins resets of all. receive() returns the results of those batch_size() machines that
  // have finished first; of all machines, by their numbers. Throw InvalidInput, and do nothing, when that
  // can't be; receive() throws a machine's failure.
  void send(std::span<const Act> acts, std::span<const std::int32_t> machines);
  void send(std::span<const int> actions, std::span<const std::int32_t> machines);
  void send_resets(std::span<const std::int64_t> seeds = {});
  void receive(const BatchArrays& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

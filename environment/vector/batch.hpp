// A vector environment for programs in the same process: it runs on threads and writes its results into
// arrays. With the default settings, its results are those of ale_py.vector_env.AtariVectorEnv of ALE 0.12,
// byte for byte (docs/spec/environment.md, 15); tests/environment/vector/test_batch.py checks that.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "environment/vector/batch_results.hpp"
#include "environment/vector/interrupt_poll.hpp"
#include "environment/vector/vector_environment.hpp"

namespace racebeam {

constexpr unsigned kMaxWorkers = 1024;  // threads of a batch

struct BatchSettings {
  SlotSettings slot;
  Autoreset autoreset = Autoreset::kNextStep;
  StackSettings stack;
  bool screens = false;        // make_results() has room for whole screens, too
  std::size_t batch_size = 0;  // how many machines one receive() returns; 0: all

  // 0: one for each processor that the process may use. At most one for each machine, and kMaxWorkers.
  unsigned threads = 0;
  int first_processor = -1;  // see ThreadPool
  std::chrono::microseconds busy_poll{50};
  std::string_view noun = "machine";  // what errors call a machine
};

// Throws InvalidInput if this many machines take more memory than the process may use. noun: as in
// BatchSettings.
void check_memory(std::size_t machines, std::string_view noun = "machine");

class Batch {
 public:
  // Creates a machine for each cartridge, powers it on and resets it. Throws InvalidInput if the settings or
  // an image cannot be used, or a thread cannot be started. `interrupt_check` may be null: see
  // set_interrupt_check().
  Batch(std::span<const Cartridge> cartridges, const BatchSettings& settings,
        InterruptCheck interrupt_check = nullptr);
  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  std::size_t size() const;
  std::size_t batch_size() const;
  int height() const;  // rows of the tallest machine's screen; zeros follow the rows of a lower one
  std::size_t observation_size() const;  // bytes for each machine
  std::size_t audio_size() const;        // bytes of sound of each machine
  unsigned threads() const;
  BatchResults make_results() const;  // of batch_size() machines

  // The action set of a machine: numbers of player A's actions. step(indices) takes indices into it.
  const std::vector<int>& actions(std::size_t machine) const;
  // Gives access to a machine, for example to its states. Throws InvalidInput while it plays, from send() to
  // receive().
  Slot& slot(std::size_t machine);

  // Sets a function that is called every 50 ms in step(), reset() and receive(), and may end them by
  // throwing; null: none. A step or reset then starts no more machines, and throws when those in progress are
  // done. Each machine has completed its step or reset, or is unchanged; `out` is undefined. A receive() has
  // received nothing.
  void set_interrupt_check(InterruptCheck interrupt_check);

  // Steps every machine once; `out` has room for all. Throws InvalidInput, and does nothing, unless there is
  // one act for each machine and every index is one of the machine's. A step allocates nothing, with three
  // exceptions that cease after a while: the first reset from each value of the timer, the first use of a
  // buffer, and records of lines where objects begin to flicker
  // (emulator/tia/line_cache/flicker_detector.hpp).
  void step(std::span<const Act> acts, const BatchArrays& out);
  void step(std::span<const int> actions, const BatchArrays& out);  // indices into actions()

  // Begins new episodes of the machines whose byte in `mask` is not 0; of all if `mask` is empty. A seed
  // of 0 or more powers the machine on anew. With a negative seed, or none, its generators continue.
  void reset(const BatchArrays& out, std::span<const std::uint8_t> mask = {},
             std::span<const std::int64_t> seeds = {});

  // Writes what all machines show now, without a step.
  void show(const BatchArrays& out) const;

  // Ends the episodes of these machines, as Slot::end_episode() does. Negative seeds mean unseeded. Throws
  // InvalidInput, and does nothing, while one of them plays.
  void end_episodes(std::span<const std::int32_t> machines, std::span<const std::int64_t> seeds = {});

  // A step in two halves, so that the caller can use the results of some machines while others play. send()
  // begins a step of each machine in `machines`; none of them may be playing. send_resets() begins a reset of
  // every machine. receive() waits for the `count` machines that finish first, and writes their results. If
  // batch_size() is size(), they follow each other as they were sent. All throw InvalidInput, and do nothing,
  // if that is impossible. receive() also throws if some of its machines have failed: the last failure. Those
  // have been received then; the results of the others are still to be received.
  void send(std::span<const Act> acts, std::span<const std::int32_t> machines);
  void send(std::span<const int> actions, std::span<const std::int32_t> machines);
  void send_resets(std::span<const std::int64_t> seeds = {});
  std::size_t playing() const;  // machines that were sent, and not received
  void receive(const BatchArrays& out, std::size_t count);
  void receive(const BatchArrays& out) { receive(out, batch_size()); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam

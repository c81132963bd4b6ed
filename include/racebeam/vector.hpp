// Many machines that step together on threads, for agents that learn: screens are resized and stacked.
// One thread at a time may use a VectorEnvironment, or several its const functions. It starts threads.
//
//     const auto image = racebeam::Image::load("builtin:beamfall");
//     racebeam::VectorEnvironment environments(image, racebeam::Game::recognise(image), 8);
//     racebeam::VectorResults results = environments.make_results();
//     environments.reset(results);
//     std::vector<int> actions(environments.size());
//     for (int step = 0; step < 100; ++step) {
//       for (std::size_t i = 0; i < actions.size(); ++i)
//         actions[i] = results.observations[i * environments.observation_size()] % 2;  // the policy
//       environments.step(actions, results);
//     }
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "racebeam/action.hpp"
#include "racebeam/config.hpp"
#include "racebeam/game.hpp"
#include "racebeam/image.hpp"
#include "racebeam/settings.hpp"
#include "racebeam/snapshot.hpp"

namespace RACEBEAM_NAMESPACE {

// The handling of a machine whose episode is over, as in Gymnasium.
enum class Autoreset {
  kNextStep,  // its next step resets it and ignores the action
  kSameStep,  // the same step resets it, and final_observations has the last observation
  kDisabled   // its steps do nothing until reset()
};

// The effect of a lost life, in the words of the line protocol. An episode that ends by it is terminated.
enum class LifeLoss {
  kIgnored,
  kReported,  // the step counts as terminated, and the episode continues
  kEnd,       // the episode ends, and the next one continues the game
  kRestart    // the episode ends, and the next one is a new game
};

struct VectorSettings {
  // The game. frame_skip and the limits of rewards and frames apply to a step. frame_skip_max,
  // truncate_on_life_loss and color_averaging must not be set; `screens` of this member has no effect.
  Settings machine{
      .frame_skip = 4, .sticky = 0, .max_episode_frames = 108000, .reward_min = -1, .reward_max = 1};
  std::optional<int> mode, difficulty;  // nothing: the game's defaults
  bool minimal_actions = true;          // false: all 18
  LifeLoss life_loss = LifeLoss::kIgnored;
  Autoreset autoreset = Autoreset::kNextStep;
  int noop_max = 30;          // an episode begins with 0 to noop_max - 1 frames of NOOP, at random
  bool fire_at_reset = true;  // and with FIRE, if the action set has it

  // Observations: the last screens, oldest first.
  int stack = 4;                // 0: no observations
  int width = 84, height = 84;  // at most twice the machine's; 0: the machine's
  bool rgb = false;             // red, green and blue of each pixel instead of one grey
  bool max_pool = true;         // each pixel is the brighter of the last two frames

  // Speed only; results do not depend on these.
  std::size_t batch_size = 0;  // how many machines one receive() returns; 0: all
  unsigned threads = 0;        // 0: one for each processor that the process may use
};

// Memory of the caller, into which results are written. In every array, the machines follow each other, in
// the order of their numbers or, from receive(), in that of `machines`. An empty array is not written.
struct VectorArrays {
  std::span<std::uint8_t> observations{};        // observation_size() bytes for each machine
  std::span<std::uint8_t> final_observations{};  // with Autoreset::kSameStep, of the episodes that ended
  std::span<std::uint8_t> ram{};                 // 128 bytes for each machine
  std::span<std::int32_t> rewards{}, lives{}, episode_frames{};  // rewards of player A
  std::span<std::uint8_t> terminated{}, truncated{};             // 0 or 1
  std::span<std::int32_t> machines{};                            // the numbers of the machines, from 0
};

// Results in their own memory. VectorEnvironment::make_results() gives every array its size.
struct VectorResults {
  std::vector<std::uint8_t> observations, final_observations, ram;
  std::vector<std::int32_t> rewards, lives, episode_frames;
  std::vector<std::uint8_t> terminated, truncated;
  std::vector<std::int32_t> machines;

  operator VectorArrays() {
    return {observations,   final_observations, ram,       rewards, lives,
            episode_frames, terminated,         truncated, machines};
  }
};

// Functions that throw Error for their arguments have done nothing then.
class RACEBEAM_API VectorEnvironment {
 public:
  // Powers machines on: `count` of one game, or one for each cartridge. The seed of machine n is that of the
  // settings plus n. Throws Error for images or settings that cannot be used, and if the machines would take
  // more memory than the process may use.
  VectorEnvironment(const Image& image, const Game& game, std::size_t count,
                    const VectorSettings& settings = {});
  explicit VectorEnvironment(std::span<const Cartridge> cartridges, const VectorSettings& settings = {});
  ~VectorEnvironment();
  VectorEnvironment(VectorEnvironment&&) noexcept;
  VectorEnvironment& operator=(VectorEnvironment&&) noexcept;

  std::size_t size() const;              // machines
  std::size_t batch_size() const;        // machines of which receive() returns the results
  std::size_t observation_size() const;  // bytes of a machine: stack x height x width [x 3]

  // The action set of a machine: step() and send() take indices into it. Throws Error unless `machine` is
  // less than size().
  std::vector<Action> actions(std::size_t machine) const;

  // Allocates results for batch_size() machines.
  VectorResults make_results() const;

  // Steps every machine, and writes the results of all. actions[n] is an index into actions(n). Throws Error
  // for an index or an array that does not fit.
  void step(std::span<const int> actions, const VectorArrays& out);

  // Begins new episodes of the machines whose byte in `reset_mask` is not 0; of all if the mask is empty. A
  // seed of 0 or more powers its machine on anew. With a negative seed, or without seeds, the random numbers
  // continue. Writes what all machines show. Only the low 32 bits of a seed count. Throws Error for arrays
  // that do not fit.
  void reset(const VectorArrays& out, std::span<const std::int64_t> seeds = {},
             std::span<const std::uint8_t> reset_mask = {});

  // Writes what all machines show now, for example after a restore. Throws Error for arrays that do not fit,
  // and between send() and receive().
  void observe(const VectorArrays& out);

  // A step in two halves, so that the caller can use the results of some machines while others play. send()
  // begins a step of the machines that it names, and returns at once: actions[i] is for machines[i]. Throws
  // Error for a machine that is playing already, or an index that does not fit.
  void send(std::span<const int> actions, std::span<const std::int32_t> machines);

  // Waits for the batch_size() machines that finish first, and writes their results; VectorArrays::machines
  // names them. Throws Error if fewer are playing.
  void receive(const VectorArrays& out);

  // Like Environment::save() and restore(), for one machine that is not playing. A snapshot contains the
  // stack of screens, too.
  Snapshot save(std::size_t machine, bool with_random = false);
  void restore(std::size_t machine, const Snapshot& snapshot);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace RACEBEAM_NAMESPACE

#include "cli/bench/batch_bench.hpp"

#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <random>

#include "cli/bench/cpu_clock.hpp"
#include "environment/vector/batch.hpp"
#include "system/resources.hpp"

namespace racebeam {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string crc(const std::vector<std::uint8_t>& bytes) {
  char text[9];
  std::snprintf(text, sizeof text, "%08lx", crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
  return text;
}

BatchSettings batch_settings(const MachineOptions& machine, const BatchBenchOptions& options) {
  BatchSettings settings;
  const Settings defaults = settings.slot.machine;
  settings.slot.machine = machine.settings;
  settings.slot.machine.max_episode_frames = defaults.max_episode_frames;
  settings.slot.machine.reward_min = defaults.reward_min;
  settings.slot.machine.reward_max = defaults.reward_max;
  settings.slot.mode = machine.mode;
  settings.slot.difficulty = machine.difficulty;
  settings.threads = static_cast<unsigned>(options.threads);
  if (options.same_step) settings.autoreset = Autoreset::kSameStep;
  return settings;
}

// Chooses the actions of each step, from the list or at random.
class Dealer {
 public:
  Dealer(const std::vector<int>& list, std::size_t choices) : list_(list), choices_(choices) {}

  void deal(std::vector<int>& actions) {
    for (int& action : actions)
      action = list_.empty() ? static_cast<int>(random_() % choices_) : list_[at_++ % list_.size()];
  }

 private:
  const std::vector<int>& list_;
  std::size_t choices_, at_ = 0;
  std::mt19937 random_{1};
};

}  // namespace

nlohmann::ordered_json time_batch(const Cartridge& cartridge, const MachineOptions& machine,
                                  const BatchBenchOptions& options, int frames,
                                  const std::vector<int>& actions) {
  const BatchSettings settings = batch_settings(machine, options);
  const auto count = static_cast<std::size_t>(options.machines);
  const double memory_before = static_cast<double>(resident_memory());
  Batch batch(std::vector<Cartridge>(count, cartridge), settings);
  BatchResults results = batch.make_results();
  const int frame_skip = settings.slot.machine.frame_skip;

  Dealer dealer(actions, batch.actions(0).size());
  std::vector<int> dealt(count);
  const auto frames_of_step = std::int64_t{options.machines} * frame_skip;
  const auto steps = static_cast<int>(std::max<std::int64_t>(1, frames / frames_of_step));
  int resets = 0;
  const double wall = wall_seconds(), cpu = cpu_seconds();
  for (int step = 0; step < steps; ++step) {
    dealer.deal(dealt);
    batch.step(dealt, results.arrays());
    resets += static_cast<int>(std::ranges::count(results.finished, 1));
  }
  const double wall_used = wall_seconds() - wall, cpu_used = cpu_seconds() - cpu;
  const double memory = static_cast<double>(resident_memory()) - memory_before;
  const double run = static_cast<double>(steps) * options.machines * frame_skip;
  return {
      {"game", cartridge.game->name},
      {"machines", options.machines},
      {"threads", options.threads},
      {"frame_skip", frame_skip},
      {"steps", steps},
      {"frames", run},
      {"seconds", wall_used},
      {"cpu_seconds", cpu_used},
      {"frames_per_second", run / wall_used},
      {"frames_per_cpu_second", run / cpu_used},
      {"episodes_ended", resets},
      {"resident_bytes_per_machine", memory / options.machines},
      {"observation_crc", crc(results.observations)},
      {"ram_crc", crc(results.ram)},
  };
}

}  // namespace racebeam

// A Batch at the other end of a pipe, for test_batch.py: batch_probe IMAGE[,IMAGE...] [setting=number]...
// The batch has a machine for each image. Standard input: for each step, an action a machine, 32-bit numbers.
// With reset=SEED in place of the seed, the machines are reset with it once they are there. With
// continuous=1, an action is three floating-point numbers: radius, angle, fire. Standard output: after the
// resets and after each step arrays of BatchResults, one after the other.
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>

#include "environment/vector/batch.hpp"

namespace racebeam {
namespace {

using Setters = std::map<std::string_view, std::function<void(BatchSettings&, double)>>;

const Setters& setters() {
  static const Setters all = {
      {"seed", [](auto& s, double v) { s.slot.machine.random_seed = static_cast<std::uint32_t>(v); }},
      {"sticky", [](auto& s, double v) { s.slot.machine.sticky = static_cast<float>(v); }},
      {"frame_skip", [](auto& s, double v) { s.slot.machine.frame_skip = static_cast<int>(v); }},
      {"max_episode_frames",
       [](auto& s, double v) { s.slot.machine.max_episode_frames = static_cast<int>(v); }},
      {"noop_max", [](auto& s, double v) { s.slot.noop_max = static_cast<int>(v); }},
      {"fire", [](auto& s, double v) { s.slot.fire_at_reset = v != 0; }},
      {"clip",
       [](auto& s, double v) {
         if (v == 0) s.slot.machine.reward_min = -(s.slot.machine.reward_max = 1 << 30);
       }},
      {"life_loss_ends",
       [](auto& s, double v) {
         if (v != 0) s.slot.life_loss = LifeLoss::kRestart;
       }},
      {"life_loss_is_told",
       [](auto& s, double v) {
         if (v != 0) s.slot.life_loss = LifeLoss::kReported;
       }},
      {"all_legal_actions",
       [](auto& s, double v) {
         if (v != 0) s.slot.action_set = ActionSet::kLegal;
       }},
      {"same_step",
       [](auto& s, double v) { s.autoreset = v != 0 ? Autoreset::kSameStep : Autoreset::kNextStep; }},
      {"stack", [](auto& s, double v) { s.stack.depth = static_cast<int>(v); }},
      {"width", [](auto& s, double v) { s.stack.width = static_cast<int>(v); }},
      {"height", [](auto& s, double v) { s.stack.height = static_cast<int>(v); }},
      {"rgb", [](auto& s, double v) { s.stack.rgb = v != 0; }},
      {"max_pool", [](auto& s, double v) { s.slot.max_pool = v != 0; }},
      {"threads", [](auto& s, double v) { s.threads = static_cast<unsigned>(v); }},
  };
  return all;
}

std::vector<Cartridge> cartridges(std::string_view list) {
  std::vector<Cartridge> all;
  while (!list.empty()) {
    const std::string_view path = list.substr(0, list.find(','));
    list.remove_prefix(std::min(path.size() + 1, list.size()));
    const auto image = load_image(std::string(path));
    all.push_back({image, recognise(*image).game});
  }
  return all;
}

template <typename T>
void write(const std::vector<T>& values) {
  std::fwrite(values.data(), sizeof(T), values.size(), stdout);
}

void write(const BatchResults& results) {
  write(results.observations);
  write(results.final_observations);
  for (const auto* numbers : {&results.rewards, &results.lives, &results.frames, &results.episode_frames})
    write(*numbers);
  for (const auto* flags : {&results.terminated, &results.truncated, &results.finished}) write(*flags);
  std::fflush(stdout);
}

// The next actions as acts; false: no more follow.
bool read_acts(const Batch& batch, std::vector<Act>& acts) {
  acts.clear();
  std::vector<float> parts(3 * batch.size());
  if (std::fread(parts.data(), sizeof(float), parts.size(), stdin) != parts.size()) return false;
  for (std::size_t i = 0; i < parts.size(); i += 3)
    acts.push_back(act_of(parts[i], parts[i + 1], parts[i + 2], 0.5F));
  return true;
}

bool read_actions(std::vector<int>& actions) {
  return std::fread(actions.data(), sizeof(int), actions.size(), stdin) == actions.size();
}

void run(std::span<char*> arguments) {
  BatchSettings settings;
  std::optional<std::int64_t> reset;
  bool continuous = false;
  for (const std::string_view word : arguments.subspan(1)) {
    const std::size_t equals = word.find('=');
    const std::string_view key = word.substr(0, equals);
    const double value = std::stod(std::string(word.substr(equals + 1)));
    if (key == "reset") {
      reset = static_cast<std::int64_t>(value);
    } else if (key == "continuous") {
      continuous = value != 0;
    } else {
      setters().at(key)(settings, value);
    }
  }
  Batch batch(cartridges(arguments[0]), settings);
  BatchResults results = batch.make_results();
  batch.show(results.arrays());
  if (reset) {
    std::vector<std::int64_t> seeds(batch.size());
    std::iota(seeds.begin(), seeds.end(), *reset);
    batch.reset(results.arrays(), {}, seeds);
  }
  write(results);
  std::vector<int> actions(batch.size());
  std::vector<Act> acts;
  while (continuous ? read_acts(batch, acts) : read_actions(actions)) {
    if (continuous) {
      batch.step(acts, results.arrays());
    } else {
      batch.step(actions, results.arrays());
    }
    write(results);
  }
}

}  // namespace
}  // namespace racebeam

int main(int count, char** arguments) {
  try {
    racebeam::run(std::span(arguments, static_cast<std::size_t>(count)).subspan(1));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "batch_probe: " << error.what() << '\n';
    return 1;
  }
}

// A Batch at the other end of a pipe, for test_batch.py: batch_probe IMAGE[,IMAGE...] [setting=number]...
// The batch has a machine for each image. Standard input: for each step, an action a machine, 32-bit numbers.
// Standard output: after the resets and after each step the arrays of BatchResults, one after the other.
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <string_view>

#include "environment/vector/batch.hpp"

namespace racebeam {
namespace {

using Setters = std::map<std::string_view, std::function<void(BatchSettings&, double)>>;

const Setters& setters() {
  static const Setters all = {
      {"seed", [](auto& s, double v) { s.machine.random_seed = static_cast<std::uint32_t>(v); }},
      {"sticky", [](auto& s, double v) { s.machine.sticky = static_cast<float>(v); }},
      {"frame_skip", [](auto& s, double v) { s.frame_skip = static_cast<int>(v); }},
      {"max_episode_frames", [](auto& s, double v) { s.max_episode_frames = static_cast<int>(v); }},
      {"noop_max", [](auto& s, double v) { s.noop_max = static_cast<int>(v); }},
      {"fire", [](auto& s, double v) { s.fire_at_reset = v != 0; }},
      {"clip", [](auto& s, double v) { s.clip_rewards = v != 0; }},
      {"life_loss_ends", [](auto& s, double v) { s.life_loss_ends = v != 0; }},
      {"life_loss_is_told", [](auto& s, double v) { s.life_loss_is_told = v != 0; }},
      {"all_legal_actions", [](auto& s, double v) { s.all_legal_actions = v != 0; }},
      {"same_step", [](auto& s, double v) { s.autoreset = v != 0 ? Autoreset::kSameStep : Autoreset::kNextStep; }},
      {"stack", [](auto& s, double v) { s.stack = static_cast<int>(v); }},
      {"max_pool", [](auto& s, double v) { s.max_pool = v != 0; }},
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

void run(std::span<char*> arguments) {
  BatchSettings settings;
  for (const std::string_view word : arguments.subspan(1)) {
    const std::size_t equals = word.find('=');
    setters().at(word.substr(0, equals))(settings, std::stod(std::string(word.substr(equals + 1))));
  }
  Batch batch(cartridges(arguments[0]), settings);
  write(batch.results());
  std::vector<int> actions(batch.size());
  while (std::fread(actions.data(), sizeof(int), actions.size(), stdin) == actions.size()) {
    batch.step(actions);
    write(batch.results());
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

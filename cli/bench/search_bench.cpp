#include "cli/bench/search_bench.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "cli/bench/cpu_clock.hpp"
#include "environment/vector/branch.hpp"

namespace racebeam {
namespace {

constexpr int kBranches = 500, kFrames = 300;
constexpr int kFramesBefore = 600;

std::vector<std::vector<Act>> random_branches(const std::vector<int>& legal, int acts) {
  std::mt19937 random{1};
  std::vector<std::vector<Act>> branches(kBranches);
  for (auto& branch : branches) {
    for (int act = 0; act < acts; ++act) branch.push_back({.a = legal[random() % legal.size()]});
  }
  return branches;
}

}  // namespace

nlohmann::ordered_json time_search(const Cartridge& cartridge, const MachineOptions& options) {
  Environment environment = power_on(cartridge, options);
  for (int frame = 0; frame < kFramesBefore && !environment.game_over(); ++frame) environment.act_for(1, 0);
  const int frame_skip = std::max(environment.settings().frame_skip, 1);
  const auto branches = random_branches(environment.game().minimal_actions, kFrames / frame_skip);
  const auto root = environment.save();
  std::vector<BranchEnd> ends(branches.size());

  const double start = cpu_seconds();
  branch(environment, *root, branches, ends);
  const double seconds = cpu_seconds() - start;

  std::int64_t frames = 0, reward = 0, over = 0;
  for (const BranchEnd& end : ends) {
    frames += end.frames;
    reward += end.reward;
    over += end.terminated;
  }
  return {
      {"game", environment.game().name},
      {"branches", kBranches},
      {"frame_skip", frame_skip},
      {"frames", frames},
      {"reward", reward},
      {"terminated", over},
      {"cpu_seconds", seconds},
      {"frames_per_second", static_cast<double>(frames) / seconds},
  };
}

}  // namespace racebeam

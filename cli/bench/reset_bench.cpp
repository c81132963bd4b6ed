#include "cli/bench/reset_bench.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include "cli/bench/cpu_clock.hpp"

namespace racebeam {
namespace {

constexpr int kFramesBetween = 50;

double time_reset(Environment& environment, std::mt19937& random) {
  const auto& legal = environment.game().legal_actions;
  for (int frame = 0; frame < kFramesBetween; ++frame) environment.act(legal[random() % legal.size()]);
  const double start = cpu_seconds();
  environment.reset_game();
  return (cpu_seconds() - start) * 1e3;
}

}  // namespace

nlohmann::ordered_json time_resets(const Cartridge& cartridge, const MachineOptions& options, int resets) {
  Environment environment = power_on(cartridge, options);
  std::mt19937 random{1};
  for (int warm = 0; warm < resets; ++warm) time_reset(environment, random);
  std::vector<double> times;
  for (int reset = 0; reset < resets; ++reset) times.push_back(time_reset(environment, random));
  double sum = 0;
  for (const double time : times) sum += time;
  std::ranges::sort(times);
  return {
      {"game", environment.game().name},
      {"resets", resets},
      {"mean_ms", sum / resets},
      {"median_ms", times[times.size() / 2]},
      {"share_under_0.1_ms",
       static_cast<double>(std::ranges::lower_bound(times, 0.1) - times.begin()) / resets},
  };
}

}  // namespace racebeam

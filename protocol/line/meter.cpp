#include "protocol/line/meter.hpp"

#include <algorithm>

namespace racebeam {

Meter::Meter(std::size_t commands) : requests(commands + 1) {}

void Meter::request(std::size_t command, bool refused, std::chrono::nanoseconds took) {
  (refused ? requests[command].refused : requests[command].done).add(1);
  const double seconds = std::chrono::duration<double>(took).count();
  const auto bound = std::ranges::lower_bound(kLatencyBounds, seconds);
  latencies[static_cast<std::size_t>(bound - kLatencyBounds.begin())].add(1);
  nanoseconds.add(took.count());
}

}  // namespace racebeam

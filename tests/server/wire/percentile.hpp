// Percentiles of latencies, by the rule of scripts/measure/load/hostile.py and cluster/simulate.py.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace wire {

// The nearest rank: the least value that at least `share` of all values do not exceed; 0 without values.
inline double percentile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const double count = static_cast<double>(sorted.size());
  const double rank = std::ceil(std::round(share * count * 1e6) / 1e6);  // 0.07 * 100 is more than 7
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace wire

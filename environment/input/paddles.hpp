// The two paddles that actions turn: player A's and player B's (docs/spec/environment.md, 2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace racebeam {

using PaddleValues = std::array<std::int32_t, 2>;  // ohms

struct PaddleLimits {
  std::int32_t min = 27450, max = 790196;

  PaddleValues middle() const {
    const auto value = static_cast<std::int32_t>((std::int64_t{min} + max) / 2);
    return {value, value};
  }

  // direction: -1 for RIGHT, 1 for LEFT, 0 for neither. The product is computed in double precision. As in
  // ALE, a product that exceeds 32 bits becomes the lowest number, and a sum that exceeds them wraps.
  std::int32_t turn(std::int32_t value, int direction, float strength) const {
    constexpr double kStep = 23000;
    constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
    const double way = std::trunc(direction * kStep * std::fabs(double{strength}));
    const bool fits = std::fabs(way) < -double{kLowest};
    const auto turn = static_cast<std::uint32_t>(fits ? static_cast<std::int32_t>(way) : kLowest);
    return std::clamp(static_cast<std::int32_t>(static_cast<std::uint32_t>(value) + turn), min, max);
  }
};

}  // namespace racebeam

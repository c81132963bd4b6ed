// The two paddles that actions turn: player A's and player B's (docs/spec/environment.md, 2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace racebeam {

using PaddleValues = std::array<std::int32_t, 2>;  // ohms

struct PaddleLimits {
  std::int32_t min = 27450, max = 790196;

  PaddleValues middle() const {
    const auto value = static_cast<std::int32_t>((std::int64_t{min} + max) / 2);
    return {value, value};
  }

  // direction: -1 for RIGHT, 1 for LEFT, 0 for neither. The product is computed in double precision.
  std::int32_t turn(std::int32_t value, int direction, float strength) const {
    constexpr double kStep = 23000, kFar = 4e9;
    const double way = std::trunc(std::min(kStep * std::fabs(double{strength}), kFar));
    const auto turned = value + direction * static_cast<std::int64_t>(way);
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(turned, min, max));
  }
};

}  // namespace racebeam

#include "agents/learning/sarsa_control.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace racebeam {

int SarsaControl::choose(const ActionValues& values) {
  if (!std::isfinite(std::accumulate(values.begin(), values.end(), 0.0))) diverged_ = true;
  if (random_.uniform() < (learning_ ? settings_.exploration : settings_.evaluation_exploration))
    return static_cast<int>(random_.below(actions_));
  const double best =
      *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(actions_));
  std::array<int, kActions> equal{};
  std::size_t count = 0;
  for (std::size_t action = 0; action < actions_; ++action)
    if (values[action] == best) equal[count++] = static_cast<int>(action);
  return count <= 1 ? equal[0] : equal[random_.below(count)];
}

std::optional<float> SarsaControl::step(double error, double gain) {
  largest_gain_ = std::max(largest_gain_, gain);
  const double step = settings_.step_size / largest_gain_ * error;
  if (std::isfinite(step)) return static_cast<float>(step);
  diverged_ = true;
  return {};
}

void SarsaControl::write(StateWriter& out) const {
  out.put(largest_gain_);
  out.put(scaled_);
  out.put(random_);
}

void SarsaControl::read(StateReader& in) {
  in.get(largest_gain_);
  in.get(scaled_);
  in.get(random_);
}

}  // namespace racebeam

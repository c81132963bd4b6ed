#include "agents/learning/ram_sarsa.hpp"

namespace racebeam {

int RamSarsa::begin(Ram ram) {
  weights_.begin(ram);
  action_ = control_.choose(weights_.values());
  weights_.take(action_);
  return action_;
}

int RamSarsa::next(double reward, Ram ram) {
  const double scaled = control_.scaled(reward), before = value_of_action();
  const std::size_t features = weights_.active();
  weights_.look(ram);
  const ActionValues values = weights_.values();
  action_ = control_.choose(values);
  learn(scaled + control_.settings().discount * values[static_cast<std::size_t>(action_)], before, features);
  weights_.take(action_);
  return action_;
}

void RamSarsa::end(double reward) {
  learn(control_.scaled(reward), value_of_action(), weights_.active());
  weights_.end();
}

void RamSarsa::learn(double target, double value, std::size_t features) {
  if (!control_.is_learning()) return;
  if (const auto step = control_.step(target - value, static_cast<double>(features))) weights_.move(*step);
}

void RamSarsa::write(StateWriter& out) const {
  weights_.write(out);
  control_.write(out);
}

void RamSarsa::read(StateReader& in) {
  weights_.read(in);
  control_.read(in);
}

}  // namespace racebeam

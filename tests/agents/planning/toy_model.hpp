// A world of places with arrows between them, for planners with known answers.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <set>
#include <vector>

#include "agents/planning/model.hpp"

namespace racebeam::test {

// What an action leads to.
struct Arrow {
  int place = 0;
  double reward = 0;
  bool over = false;
};

class ToyModel final : public Model {
 public:
  using World = std::function<Arrow(int place, int action)>;

  ToyModel(int actions, World world) : actions_(actions), world_(std::move(world)) {}

  static State place(int number, bool over = false) {
    return std::make_shared<const Arrow>(Arrow{number, 0, over});
  }
  static const Arrow& arrow(const State& state) { return *static_cast<const Arrow*>(state.get()); }

  int actions() const override { return actions_; }
  void enter(const State& state) override {
    here_ = arrow(state);
    note();
  }
  double act(int action) override {
    frames_ += 5;
    here_ = world_(here_.place, action);
    note();
    return here_.reward;
  }
  bool over() const override { return here_.over; }
  State save() const override {
    State state = place(here_.place, here_.over);
    saved_.push_back(state);
    return state;
  }
  // How many of the states that it has saved still exist.
  std::ptrdiff_t states() const {
    return std::ranges::count_if(saved_, [](const auto& state) { return !state.expired(); });
  }
  std::uint64_t hash(const State& state) const override {
    return static_cast<std::uint64_t>(arrow(state).place) % 2;  // collisions do no harm
  }
  bool equal(const State& a, const State& b) const override { return arrow(a).place == arrow(b).place; }
  std::span<const std::uint8_t> features() const override { return features_; }
  std::int64_t frames() const override { return frames_; }

 private:
  void note() {
    features_ = {static_cast<std::uint8_t>(here_.place), static_cast<std::uint8_t>(here_.place >> 8)};
  }

  const int actions_;
  const World world_;
  Arrow here_;
  std::array<std::uint8_t, 2> features_{};
  std::int64_t frames_ = 0;
  mutable std::vector<std::weak_ptr<const void>> saved_;
};

// A trap: action 0 gives 1 now and 0 ever after; action 1 gives nothing now, and 10 after another 1.
inline Arrow trap(int place, int action) {
  if (place == 0) return action == 0 ? Arrow{1, 1} : Arrow{2, 0};
  if (place == 2) return action == 1 ? Arrow{1, 10} : Arrow{2, 0};
  return {1, 0};
}

// The first action decides between an end with 5, and going on with 1 a step.
inline Arrow end_or_on(int place, int action) {
  if (place == 0 && action == 0) return {1, 5, true};
  return {place + 1, 1};
}

}  // namespace racebeam::test

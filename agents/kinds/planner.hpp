// Agents that search before each decision. They play on the game's machine, and search on their own.
#pragma once

#include "agents/base/agent.hpp"
#include "agents/kinds/agent_table.hpp"
#include "agents/planning/machine_model.hpp"

namespace racebeam {

// Search is TreeSearch, RolloutSearch or Uct.
template <typename Search, typename Settings>
class Planner final : public Agent {
 public:
  Planner(const AgentContext& context, const Settings& settings)
      : actions_(context.actions()),
        model_(context.cartridge, context.play.machine, static_cast<std::uint32_t>(context.seed) | 1U,
               actions_),
        search_(model_, settings, context.seed) {}

  int begin(const Environment& environment) override {
    search_.forget();
    return choose(MachineModel::state_of(environment));
  }
  int next(double, const Environment& environment) override {
    const Model::State state = MachineModel::state_of(environment);
    search_.keep(number_, state);
    return choose(state);
  }
  void end(double) override { search_.forget(); }
  std::int64_t searched_frames() const override { return model_.frames(); }
  void write(StateWriter& out) const override {
    search_.write(out);
    model_.write(out);
  }
  void read(StateReader& in) override {
    search_.read(in);
    model_.read(in);
  }

 private:
  int choose(const Model::State& state) {
    number_ = search_.choose(state);
    return actions_[static_cast<std::size_t>(number_)];
  }

  const std::vector<int> actions_;
  MachineModel model_;
  Search search_;
  int number_ = 0;  // of the last action
};

}  // namespace racebeam

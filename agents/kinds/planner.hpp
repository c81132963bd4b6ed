// Agents that search before each decision. They play on the game's machine, and search on their own.
#pragma once

#include "agents/base/agent.hpp"
#include "agents/kinds/agent_table.hpp"
#include "agents/planning/machine_model.hpp"
#include "agents/planning/search_tree.hpp"
#include "agents/planning/uct.hpp"

namespace racebeam {

// The full tree, and IW(1).
class TreePlanner final : public Agent {
 public:
  TreePlanner(const AgentContext& context, const TreeSettings& settings)
      : model_(context.cartridge, context.play.machine, static_cast<std::uint32_t>(context.seed) | 1U),
        search_(model_, settings, context.seed) {}

  int begin(const Environment& environment) override {
    return search_.choose(MachineModel::state_of(environment));
  }
  int next(double, const Environment& environment) override { return begin(environment); }
  void end(double) override {}
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
  MachineModel model_;
  TreeSearch search_;
};

class UctPlanner final : public Agent {
 public:
  UctPlanner(const AgentContext& context, const UctSettings& settings)
      : model_(context.cartridge, context.play.machine, static_cast<std::uint32_t>(context.seed) | 1U),
        uct_(model_, settings, context.seed) {}

  int begin(const Environment& environment) override {
    uct_.forget();
    return action_ = uct_.choose(MachineModel::state_of(environment));
  }
  int next(double, const Environment& environment) override {
    const Model::State state = MachineModel::state_of(environment);
    uct_.keep(action_, state);
    return action_ = uct_.choose(state);
  }
  void end(double) override { uct_.forget(); }
  std::int64_t searched_frames() const override { return model_.frames(); }
  void write(StateWriter& out) const override {
    uct_.write(out);
    model_.write(out);
  }
  void read(StateReader& in) override {
    uct_.read(in);
    model_.read(in);
  }

 private:
  MachineModel model_;
  Uct uct_;
  int action_ = 0;
};

}  // namespace racebeam

// A machine as a planner's model. The planner has this machine for itself: it never sees the random numbers
// of the game that is played. With sticky actions, the model draws its own.
#pragma once

#include "agents/base/state_bytes.hpp"
#include "agents/planning/model.hpp"
#include "environment/environment.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

class MachineModel final : public Model {
 public:
  // actions: those that are tried, which the planner numbers from 0.
  MachineModel(const Cartridge& cartridge, Settings settings, std::uint32_t seed,
               const std::vector<int>& actions = all_actions());

  // The state of the game that is played, without its generator and its pictures. Pictures would take most of
  // the memory of a tree, and of the time to save.
  static State state_of(const Environment& game) { return game.save_without_pictures(); }

  int actions() const override { return static_cast<int>(actions_.size()); }
  void enter(const State& state) override;
  double act(int action) override;
  bool over() const override { return machine_.game_over(); }
  State save() const override { return state_of(machine_); }
  // Without sticky actions, the held actions decide nothing, since each action replaces them. States that
  // differ only in them are equal, as the paper's duplicates are.
  std::uint64_t hash(const State& state) const override;
  bool equal(const State& a, const State& b) const override;
  std::span<const std::uint8_t> features() const override { return machine_.ram(); }
  std::int64_t frames() const override { return frames_; }

  // Write and read what persists between searches, for checkpoints: the generator of sticky actions.
  void write(StateWriter& out) const;
  void read(StateReader& in);

 private:
  const bool sticky_;
  const std::vector<int> actions_;
  Environment machine_;
  std::int64_t frames_ = 0;
};

}  // namespace racebeam

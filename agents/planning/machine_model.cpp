#include "agents/planning/machine_model.hpp"

#include "environment/saved/saved_state_check.hpp"
#include "environment/saved_state.hpp"

namespace racebeam {
namespace {

const Environment::Saved& saved_of(const Model::State& state) {
  return *static_cast<const Environment::Saved*>(state.get());
}

// The parts of a state that decide the future.
struct Parts {
  racebeam::State machine;
  EpisodeState play;
  const Environment::Saved& saved;

  Parts(const Model::State& state, bool sticky)
      : machine(saved_of(state).values.machine), play(saved_of(state).values.play), saved(saved_of(state)) {
    if (sticky) return;
    machine.inputs.joystick = {};
    machine.inputs.paddle_fire = 0;
    play.held = {};
  }
  StateParts parts() const { return {machine, play, saved.values.rule, saved.cartridge_ram}; }
};

Settings with_seed(Settings settings, std::uint32_t seed) {
  settings.random_seed = seed;
  return settings;
}

}  // namespace

MachineModel::MachineModel(const Cartridge& cartridge, Settings settings, std::uint32_t seed,
                           const std::vector<int>& actions)
    : sticky_(settings.sticky > 0),
      actions_(actions),
      machine_(cartridge.image, cartridge.game, with_seed(settings, seed)) {
  machine_.set_drawing(Drawing::kNone);
}

void MachineModel::enter(const State& state) { machine_.restore(saved_of(state)); }

double MachineModel::act(int action) {
  const int before = machine_.frame_number();
  const int reward = machine_.act(actions_[static_cast<std::size_t>(action)]);
  frames_ += frames_between(before, machine_.frame_number());
  return reward;
}

std::uint64_t MachineModel::hash(const State& state) const {
  return state_hash(Parts(state, sticky_).parts());
}

bool MachineModel::equal(const State& a, const State& b) const {
  return same_state(Parts(a, sticky_).parts(), Parts(b, sticky_).parts());
}

void MachineModel::write(StateWriter& out) const {
  if (sticky_) out.put(*machine_.save(true)->random);
}

void MachineModel::read(StateReader& in) {
  if (!sticky_) return;
  MersenneTwister random;
  in.get(random);
  check_generator(random.words(), random.position());
  Environment::Saved state(*machine_.save());
  state.random = std::make_shared<const MersenneTwister>(random);
  machine_.restore(state);
}

}  // namespace racebeam

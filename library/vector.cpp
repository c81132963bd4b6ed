#include "racebeam/vector.hpp"

#include <algorithm>
#include <string>

#include "environment/saved_state.hpp"
#include "environment/vector/batch.hpp"
#include "library/internals.hpp"

namespace racebeam::v0 {
namespace {

racebeam::Autoreset internal(Autoreset autoreset) {
  switch (autoreset) {
    case Autoreset::kSameStep: return racebeam::Autoreset::kSameStep;
    case Autoreset::kDisabled: return racebeam::Autoreset::kDisabled;
    default: return racebeam::Autoreset::kNextStep;
  }
}

racebeam::LifeLoss internal(LifeLoss life_loss) {
  switch (life_loss) {
    case LifeLoss::kReported: return racebeam::LifeLoss::kReported;
    case LifeLoss::kEnd: return racebeam::LifeLoss::kEnd;
    case LifeLoss::kRestart: return racebeam::LifeLoss::kRestart;
    default: return racebeam::LifeLoss::kIgnored;
  }
}

BatchSettings internal(const VectorSettings& settings) {
  return {.slot = {.machine = v0::internal(settings.machine),
                   .mode = settings.mode,
                   .difficulty = settings.difficulty,
                   .action_set = settings.minimal_actions ? ActionSet::kMinimal : ActionSet::kFull,
                   .noop_max = settings.noop_max,
                   .fire_at_reset = settings.fire_at_reset,
                   .life_loss = internal(settings.life_loss),
                   .max_pool = settings.max_pool},
          .autoreset = internal(settings.autoreset),
          .stack = {.depth = settings.stack,
                    .width = settings.width,
                    .height = settings.height,
                    .rgb = settings.rgb},
          .batch_size = settings.batch_size,
          .threads = settings.threads};
}

BatchArrays internal(const VectorArrays& arrays) {
  BatchArrays out;
  out.observations = arrays.observations;
  out.final_observations = arrays.final_observations;
  out.ram = arrays.ram;
  out.rewards = arrays.rewards;
  out.lives = arrays.lives;
  out.episode_frames = arrays.episode_frames;
  out.terminated = arrays.terminated;
  out.truncated = arrays.truncated;
  out.numbers = arrays.machines;
  return out;
}

template <class Element>
void check_size(const char* name, std::span<Element> array, std::size_t size) {
  if (array.empty() || array.size() == size) return;
  throw Error(Error::Cause::kArgument, std::string(name) + " has " + std::to_string(array.size()) +
                                           " elements; it must have " + std::to_string(size) + ", or none");
}

std::vector<racebeam::Cartridge> internal(std::span<const Cartridge> cartridges) {
  std::vector<racebeam::Cartridge> internals;
  for (const Cartridge& one : cartridges) internals.push_back(Internals::cartridge(one.image, one.game));
  return internals;
}

}  // namespace

struct VectorEnvironment::Impl {
  Impl(std::vector<racebeam::Cartridge> loaded, const VectorSettings& settings)
      : cartridges(std::move(loaded)), batch(cartridges, internal(settings)) {}

  // Whether each array has room for this many machines, or is left out.
  void check_sizes(const VectorArrays& arrays, std::size_t machines) const {
    check_size("observations", arrays.observations, machines * batch.observation_size());
    check_size("final_observations", arrays.final_observations, machines * batch.observation_size());
    check_size("ram", arrays.ram, machines * kRamSize);
    check_size("rewards", arrays.rewards, machines);
    check_size("lives", arrays.lives, machines);
    check_size("episode_frames", arrays.episode_frames, machines);
    check_size("terminated", arrays.terminated, machines);
    check_size("truncated", arrays.truncated, machines);
    check_size("machines", arrays.machines, machines);
  }

  void check_number(std::size_t machine) const {
    if (machine < batch.size()) return;
    throw Error(Error::Cause::kArgument, "machine " + std::to_string(machine) +
                                             " is out of range; accepted: 0 to " +
                                             std::to_string(batch.size() - 1));
  }

  // A machine that does not play now.
  Slot& slot(std::size_t machine) {
    check_number(machine);
    return guarded(Error::Cause::kArgument, [&]() -> Slot& { return batch.slot(machine); });
  }

  const std::vector<racebeam::Cartridge> cartridges;
  Batch batch;
};

VectorEnvironment::VectorEnvironment(std::span<const Cartridge> cartridges, const VectorSettings& settings)
    : impl_(guarded(Error::Cause::kSettings,
                    [&] { return std::make_unique<Impl>(internal(cartridges), settings); })) {}

VectorEnvironment::VectorEnvironment(const Image& image, const Game& game, std::size_t count,
                                     const VectorSettings& settings)
    : impl_(guarded(Error::Cause::kSettings, [&] {
        return std::make_unique<Impl>(std::vector(count, Internals::cartridge(image, game)), settings);
      })) {}

VectorEnvironment::~VectorEnvironment() = default;
VectorEnvironment::VectorEnvironment(VectorEnvironment&&) noexcept = default;
VectorEnvironment& VectorEnvironment::operator=(VectorEnvironment&&) noexcept = default;

std::size_t VectorEnvironment::size() const { return impl_->batch.size(); }
std::size_t VectorEnvironment::batch_size() const { return impl_->batch.batch_size(); }
std::size_t VectorEnvironment::observation_size() const { return impl_->batch.observation_size(); }

std::vector<Action> VectorEnvironment::actions(std::size_t machine) const {
  impl_->check_number(machine);
  std::vector<Action> actions;
  for (const int number : impl_->batch.actions(machine)) actions.push_back(static_cast<Action>(number));
  return actions;
}

VectorResults VectorEnvironment::make_results() const {
  BatchResults results = impl_->batch.make_results();
  return {.observations = std::move(results.observations),
          .final_observations = std::move(results.final_observations),
          .ram = std::move(results.ram),
          .rewards = std::move(results.rewards),
          .lives = std::move(results.lives),
          .episode_frames = std::move(results.episode_frames),
          .terminated = std::move(results.terminated),
          .truncated = std::move(results.truncated),
          .machines = std::move(results.numbers)};
}

void VectorEnvironment::step(std::span<const int> actions, const VectorArrays& out) {
  impl_->check_sizes(out, size());
  guarded(Error::Cause::kArgument, [&] { impl_->batch.step(actions, internal(out)); });
}

void VectorEnvironment::reset(const VectorArrays& out, std::span<const std::int64_t> seeds,
                              std::span<const std::uint8_t> reset_mask) {
  impl_->check_sizes(out, size());
  guarded(Error::Cause::kArgument, [&] { impl_->batch.reset(internal(out), reset_mask, seeds); });
}

void VectorEnvironment::observe(const VectorArrays& out) {
  impl_->check_sizes(out, size());
  guarded(Error::Cause::kArgument, [&] { impl_->batch.show(internal(out)); });
}

void VectorEnvironment::send(std::span<const int> actions, std::span<const std::int32_t> machines) {
  guarded(Error::Cause::kArgument, [&] { impl_->batch.send(actions, machines); });
}

void VectorEnvironment::receive(const VectorArrays& out) {
  impl_->check_sizes(out, batch_size());
  guarded(Error::Cause::kArgument, [&] { impl_->batch.receive(internal(out)); });
}

Snapshot VectorEnvironment::save(std::size_t machine, bool with_random) {
  const Slot& slot = impl_->slot(machine);
  return Internals::wrap(impl_->cartridges[machine], slot.environment().settings(),
                         slot.save(with_random, with_random), true);
}

void VectorEnvironment::restore(std::size_t machine, const Snapshot& snapshot) {
  Slot& slot = impl_->slot(machine);
  guarded(Error::Cause::kSnapshot, [&] {
    const Slot::Saved saved = Internals::saved(snapshot, slot.environment());
    slot.check_stack(saved);
    slot.restore(saved);
  });
}

}  // namespace racebeam::v0

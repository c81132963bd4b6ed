#include "environment/vector/vector_environment.hpp"

#include "environment/vector/first_failure.hpp"

namespace racebeam {
namespace {

SlotSettings settings_of(const SlotSettings& settings, std::size_t number) {
  SlotSettings own = settings;
  own.machine.random_seed += static_cast<std::uint32_t>(number);
  return own;
}

}  // namespace

std::optional<std::uint32_t> seed_of(std::int64_t seed) {
  return seed < 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(seed));
}

VectorEnvironment::VectorEnvironment(std::span<const Cartridge> cartridges, const SlotSettings& settings,
                                     Autoreset autoreset, VectorHost& host)
    : autoreset_(autoreset), host_(host), slots_(cartridges.size()) {
  run([&](std::size_t number) {
    slots_[number] =
        std::make_unique<Slot>(cartridges[number], settings_of(settings, number), host_.pace(number));
    host_.opened(number, *slots_[number]);
    host_.show(number, *slots_[number]);
  });
}

// A failure is thrown at the end, since tasks run on any thread. A cancelled fiber unwinds with something
// that is not a std::exception, and that must pass.
template <typename Task>
void VectorEnvironment::run(Task task) {
  FirstFailure failure;
  const auto guarded = [&](std::size_t number) {
    if (failure.is_before(number)) return;
    try {
      task(number);
    } catch (const std::exception&) {
      failure.keep(number);
    }
  };
  host_.run_all(slots_.size(), std::ref(guarded));
  failure.check();
}

void VectorEnvironment::step(std::span<const Act> acts) {
  run([&](std::size_t number) { step_one(number, acts[number]); });
}

void VectorEnvironment::reset(std::span<const std::uint8_t> mask, std::span<const std::int64_t> seeds) {
  run([&](std::size_t number) {
    if (mask.empty() || mask[number] != 0) return reset_one(number, seeds.empty() ? -1 : seeds[number]);
    slots_[number]->begin_request();
    host_.show(number, *slots_[number]);
  });
}

void VectorEnvironment::step_one(std::size_t number, const Act& act) {
  Slot& slot = *slots_[number];
  slot.begin_request();
  if (slot.finished() && autoreset_ == Autoreset::kNextStep) {
    slot.reset();
  } else {
    // With same-step, only a restored state can have ended before.
    if (slot.finished() && autoreset_ == Autoreset::kSameStep) slot.reset();
    slot.act(act);
    if (slot.finished() && autoreset_ == Autoreset::kSameStep) {
      host_.ended(number, slot);
      const Outcome outcome = slot.outcome();
      slot.reset();
      slot.set_outcome(outcome);
    }
  }
  host_.show(number, slot);
}

void VectorEnvironment::reset_one(std::size_t number, std::int64_t seed) {
  Slot& slot = *slots_[number];
  slot.begin_request();
  slot.reset(seed_of(seed));
  host_.show(number, slot);
}

}  // namespace racebeam

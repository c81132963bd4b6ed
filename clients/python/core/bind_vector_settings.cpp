// VectorSettings: the settings with which VectorMachines are made. Some of them are words.
#include <nanobind/stl/optional.h>

#include <type_traits>

#include "clients/python/core/bindings.hpp"
#include "environment/vector/batch.hpp"

namespace racebeam::python {
namespace {

namespace nb = nanobind;

void bind_words(nb::module_& module) {
  nb::enum_<Rules>(module, "Rules").value("ALE_0_12", Rules::kAle012).value("FIXED", Rules::kFixed);
  nb::enum_<ActionSet>(module, "ActionSet")
      .value("LEGAL", ActionSet::kLegal)
      .value("MINIMAL", ActionSet::kMinimal)
      .value("CONSOLE", ActionSet::kConsole);
  nb::enum_<Autoreset>(module, "Autoreset")
      .value("NEXT_STEP", Autoreset::kNextStep)
      .value("SAME_STEP", Autoreset::kSameStep)
      .value("DISABLED", Autoreset::kDisabled);
  nb::enum_<ResetOrder>(module, "ResetOrder")
      .value("FIRE_NOOPS", ResetOrder::kFireNoops)
      .value("NOOPS_FIRE", ResetOrder::kNoopsFire)
      .value("BASELINES", ResetOrder::kBaselines);
  nb::enum_<LifeLoss>(module, "LifeLoss")
      .value("IGNORED", LifeLoss::kIgnored)
      .value("REPORTED", LifeLoss::kReported)
      .value("END", LifeLoss::kEnd)
      .value("RESTART", LifeLoss::kRestart);
  nb::enum_<StackStart>(module, "StackStart")
      .value("ZEROS", StackStart::kZeros)
      .value("REPEATS", StackStart::kRepeats);
}

// path: pointers to members of members, the first of which is a member of BatchSettings.
template <class... Members>
void bind(nb::class_<BatchSettings>& settings, const char* name, Members... path) {
  const auto at = [path...](BatchSettings & self) -> auto& { return (self.*....*path); };
  using Value = std::remove_cvref_t<decltype(at(std::declval<BatchSettings&>()))>;
  settings.def_prop_rw(
      name, [at](BatchSettings& self) { return at(self); },
      [at](BatchSettings& self, Value value) { at(self) = value; });
}

}  // namespace

void bind_vector_settings(nb::module_& module) {
  bind_words(module);
  nb::class_<BatchSettings> settings(module, "VectorSettings", "The settings of VectorMachines.");
  settings.def(nb::init<>());
  const auto slot = &BatchSettings::slot;
  const auto machine = &SlotSettings::machine;
  const auto stack = &BatchSettings::stack;
  bind(settings, "seed", slot, machine, &Settings::random_seed);
  bind(settings, "rules", slot, machine, &Settings::rules);
  bind(settings, "sticky", slot, machine, &Settings::sticky);
  bind(settings, "sound", slot, machine, &Settings::sound);
  bind(settings, "all_audio", slot, &SlotSettings::all_audio);
  bind(settings, "frame_skip", slot, machine, &Settings::frame_skip);
  bind(settings, "max_episode_frames", slot, machine, &Settings::max_episode_frames);
  bind(settings, "reward_min", slot, machine, &Settings::reward_min);
  bind(settings, "reward_max", slot, machine, &Settings::reward_max);
  bind(settings, "mode", slot, &SlotSettings::mode);
  bind(settings, "difficulty", slot, &SlotSettings::difficulty);
  bind(settings, "action_set", slot, &SlotSettings::action_set);
  bind(settings, "start", slot, &SlotSettings::reset_order);
  bind(settings, "noop_max", slot, &SlotSettings::noop_max);
  bind(settings, "fire", slot, &SlotSettings::fire_at_reset);
  bind(settings, "lives", slot, &SlotSettings::life_loss);
  bind(settings, "stack_start", slot, &SlotSettings::stack_start);
  bind(settings, "pool", slot, &SlotSettings::max_pool);
  bind(settings, "autoreset", &BatchSettings::autoreset);
  bind(settings, "stack", stack, &StackSettings::depth);
  bind(settings, "width", stack, &StackSettings::width);
  bind(settings, "height", stack, &StackSettings::height);
  bind(settings, "rgb", stack, &StackSettings::rgb);
  bind(settings, "rows", stack, &StackSettings::rows);
  bind(settings, "screens", &BatchSettings::screens);
  bind(settings, "batch_size", &BatchSettings::batch_size);
  bind(settings, "threads", &BatchSettings::threads);
  bind(settings, "first_processor", &BatchSettings::first_processor);
}

}  // namespace racebeam::python
